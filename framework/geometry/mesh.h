#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace pliant {

/// A named way in which a mesh can change its form.
struct MorphTarget {
  std::string name;
  std::vector<Eigen::Vector3f> displacements;  ///< mm, of every vertex at weight 1
};

/// Triangles over a list of vertices, in mm in a frame of the mesh's own. The corners of a triangle run
/// counter-clockwise when seen from outside.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  ///< at rest: every weight 0
  std::vector<Eigen::Vector3i> triangles;
  std::vector<MorphTarget> targets;

  std::vector<std::string> target_names() const;

  /// The vertices displaced by `weights`, one for each target; any finite weight is allowed.
  /// Throws std::invalid_argument when the number of weights or of displacements does not fit.
  std::vector<Eigen::Vector3d> deform(const std::vector<double>& weights) const;
};

}  // namespace pliant
