#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/modeller/figure.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// A form that a figure takes, so that there is one half-way between any two: how much of every morph target,
/// and how far every joint turns.
struct FigurePose {
  std::vector<double> weights;  ///< of every morph target
  std::vector<Eigen::Vector3d>
      degrees;  ///< of every joint, about the axes of its own frame: x, then y, then z
};

/// The form in which nothing is displaced or turned.
FigurePose rest_of(const Mesh& mesh);

/// Adds `share` of a named pose: 1 is the pose itself; any finite share is allowed. Throws
/// std::invalid_argument for a target or joint that the mesh does not have (the nearest is named).
void add_pose(const Mesh& mesh, const NamedPose& named, double share, FigurePose& pose);

/// A form of the mesh with a pose on top: weights are added, and joints turn after what they do already.
MeshPose on_top(MeshPose beneath, const FigurePose& pose);

}  // namespace pliant
