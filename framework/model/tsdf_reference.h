#pragma once

#include <Eigen/Geometry>

#include "framework/geometry/surface.h"
#include "framework/model/tsdf.h"

namespace pliant {

/// Plain C++ reference of Tsdf::integrate: fuses a map into `voxels`, bit for bit as the device does.
void integrate_reference(const TsdfGrid& grid, int max_weight, const DepthMap& depth, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_model, TsdfVoxels& voxels, int weight = 1);
/// The same of the one through a lattice.
void integrate_reference(const TsdfGrid& grid, int max_weight, const DepthMap& depth, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_model, const DisplacementLattice& lattice,
                         TsdfVoxels& voxels);

/// Plain C++ reference of Tsdf::raycast, over the whole image: passes over no empty space and takes steps of
/// a voxel, so that it may find what the device's longer steps pass over, as where the surface is seen from
/// its edge.
SurfaceImage raycast_reference(const TsdfGrid& grid, const TsdfVoxels& voxels, const Camera& camera,
                               const Eigen::Isometry3d& camera_from_model);

}  // namespace pliant
