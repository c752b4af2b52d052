#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "framework/geometry/mesh.h"

namespace pliant {

/// Some numbers that change with time, known at keys. Before the first key they are that one's, after the
/// last that one's.
struct Track {
  enum class Interpolation {
    step,    ///< a key's numbers until the next
    linear,  ///< straight from key to key
    cubic    ///< Hermite splines; a key has three times as many numbers: tangent in, value, tangent out
  };
  Interpolation interpolation = Interpolation::linear;
  std::size_t width = 0;       ///< how many numbers change together
  std::vector<double> times;   ///< s, of the keys, at least one, each later than the one before
  std::vector<double> values;  ///< key by key; of tangents per second

  /// `width` numbers. Linear ones are interpolated one by one.
  std::vector<double> at(double seconds) const;
  /// The numbers as a rotation (x y z w): linear ones go along the shorter arc at constant speed (slerp),
  /// cubic ones are brought to unit length.
  Eigen::Quaterniond rotation_at(double seconds) const;
};

/// How a joint moves: from its frame to its parent's by scaling, then turning, then shifting.
struct JointMotion {
  int joint = 0;
  // What holds where no track changes it.
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< mm
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();

  std::optional<Track> translations;  ///< 3 numbers, mm
  std::optional<Track> rotations;     ///< 4 numbers, a quaternion x y z w
  std::optional<Track> scales;        ///< 3 numbers

  Eigen::Affine3d at(double seconds) const;
};

/// How weights of morph targets change.
struct WeightMotion {
  std::vector<std::size_t> targets;  ///< which of the mesh's, as many as the track has numbers
  Track weights;
};

/// A named motion of a mesh.
struct Animation {
  std::string name;
  double duration = 0;  ///< s, the time of the last key
  std::vector<JointMotion> joints;
  std::vector<WeightMotion> weights;

  /// The form that `mesh`, whose motion this is, takes so many seconds after the beginning; what does not
  /// move is at rest. Where two motions change one weight the later in the list counts. Throws
  /// std::invalid_argument when the mesh has not the joints or targets that this moves.
  MeshPose pose(const Mesh& mesh, double seconds) const;
};

}  // namespace pliant
