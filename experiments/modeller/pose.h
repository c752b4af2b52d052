#pragma once

#include "experiments/modeller/figure.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// The pose of a figure's mesh at `share` of a named pose: 0 is rest, 1 the pose itself; any finite share is
/// allowed. Throws std::invalid_argument for a target or joint that the mesh does not have.
MeshPose mesh_pose(const Mesh& mesh, const NamedPose& pose, double share = 1);

}  // namespace pliant
