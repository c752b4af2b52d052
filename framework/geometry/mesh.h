#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace pliant {

/// A named way in which a mesh can change its form.
struct MorphTarget {
  std::string name;
  std::vector<Eigen::Vector3f> displacements;  ///< mm, of every vertex at weight 1
};

/// A frame of reference that carries a part of a mesh: a bone, or a node of a scene.
struct Joint {
  std::string name;
  int parent = -1;  ///< a joint before this one; -1: the mesh itself
  /// From the joint's frame to its parent's, at rest.
  Eigen::Affine3d rest = Eigen::Affine3d::Identity();
  /// From the mesh's frame to the joint's, at the pose in which vertices were bound to it.
  Eigen::Affine3d joint_from_mesh = Eigen::Affine3d::Identity();
};

/// The joints that carry a vertex, and how much of it each has; unused ones have weight 0.
struct JointWeights {
  Eigen::Vector4i joints = Eigen::Vector4i::Zero();
  Eigen::Vector4f weights = Eigen::Vector4f::Zero();  ///< they sum to 1
};

/// One form that a mesh takes.
struct MeshPose {
  std::vector<double> weights;          ///< of every morph target; any finite ones are allowed
  std::vector<Eigen::Affine3d> joints;  ///< from each joint's frame to its parent's
};

/// Triangles over a list of vertices, in mm in a frame of the mesh's own. The corners of a triangle run
/// counter-clockwise when seen from outside.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  ///< at rest: every weight 0
  std::vector<Eigen::Vector3i> triangles;
  std::vector<MorphTarget> targets;
  std::vector<Joint> joints = {};
  std::vector<JointWeights> skin = {};  ///< of every vertex; empty: no joint carries any

  std::vector<std::string> target_names() const;

  /// The vertices displaced by `weights`, one for each target; any finite weight is allowed.
  /// Throws std::invalid_argument when the number of weights or of displacements does not fit.
  std::vector<Eigen::Vector3d> deform(const std::vector<double>& weights) const;

  MeshPose rest() const;

  /// The vertices displaced by the pose's weights, then carried by its joints: linear blend skinning.
  /// Throws std::invalid_argument as above, or when the number of joints or of skinned vertices does not fit,
  /// or a joint or vertex names a joint that it may not.
  std::vector<Eigen::Vector3d> deform(const MeshPose& pose) const;
};

}  // namespace pliant
