#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// Where the samples of a truncated signed distance field lie [Curless and Levoy, "A volumetric method for
/// building complex models from range images", SIGGRAPH 1996]: a grid of cubic voxels along the axes of the
/// model's frame.
struct TsdfGrid {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();    ///< voxels along x, y, z: whole bricks
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< mm, of the centre of voxel (0, 0, 0)
  double voxel = 0;                                  ///< mm between neighbouring voxels
  double truncation = 0;                             ///< mm: distances are known up to here

  /// Voxels that are looked at or left out together.
  static constexpr int brick_width = 16, brick_height = 8, brick_depth = 8;
  /// Pixels along each side of the squares for which depth is bounded.
  static constexpr int tile = 16;
  /// A distance is kept as a whole number of so many parts of the truncation, positive before the surface; as
  /// 0 where nothing was observed.
  static constexpr int steps = 32767;

  std::size_t voxels() const;
  Eigen::Vector3i bricks() const;

  /// x y z of a point as it counts in voxels, one row each, with what is added.
  Eigen::Affine3d model_from_voxel() const;
};

/// Bricks along x, y, z, as kernels take them.
cl_int4 bricks_of(const TsdfGrid& grid);

/// The rows of a transform one after another, as kernels and their references take it.
cl_float16 rows_of(const Eigen::Affine3d& transform);

/// How far from the surface distances are known: so many voxels, and so many mm at least.
struct TruncationBand {
  double voxels = 0;
  double least = 0;                                                          ///< mm
  double of(double voxel) const { return std::max(voxels * voxel, least); }  ///< mm
};

/// A cube of `side` mm and `resolution` voxels before the first camera, on its axis, from `distance` mm on.
/// `resolution`: a multiple of TsdfGrid::brick_width.
TsdfGrid grid_before_camera(int resolution, double side, double distance, const TruncationBand& truncation);

/// The smallest grid around the points of a surface and `margin` times their longest extent on each side;
/// that longest side has `resolution` voxels. The hundredth of the points that lies farthest out along an
/// axis is not waited for: a few wrong ones among those would take the voxels from the rest. Throws DataError
/// where there is no point. Waits for the device.
TsdfGrid grid_around(const SurfaceMap& seen, int resolution, double margin, const TruncationBand& truncation);

/// `source` behind lanes.cl, surface_map.cl and tsdf_grid.cl: what kernels over such grids share.
std::string with_tsdf_grid(std::string_view source);
/// A kernel of such a source.
cl::Kernel tsdf_kernel(Device& device, std::string_view source, const std::string& name);

}  // namespace pliant
