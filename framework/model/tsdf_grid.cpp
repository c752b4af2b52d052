#include "framework/model/tsdf_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "framework/core/error.h"
#include "framework/imaging/depth_map.h"
#include "framework/model/tsdf_grid.cl.embed.h"

namespace pliant {
namespace {

const Eigen::Vector3i brick(TsdfGrid::brick_width, TsdfGrid::brick_height, TsdfGrid::brick_depth);

Eigen::Vector3i whole_bricks(const Eigen::Vector3d& voxels) {
  const Eigen::Vector3i least = voxels.array().ceil().cast<int>();
  return ((least + brick).array() - 1).cwiseQuotient(brick.array()) * brick.array();
}

struct Extent {
  double least, greatest;
};

/// Of values without the hundredth at either end.
Extent extent_of(std::vector<float>& values) {
  const auto rank = static_cast<std::ptrdiff_t>(values.size() / 100);
  const auto low = values.begin() + rank;
  const auto high = values.end() - 1 - rank;
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

}  // namespace

std::size_t TsdfGrid::voxels() const { return size.cast<std::size_t>().prod(); }

Eigen::Vector3i TsdfGrid::bricks() const { return size.cwiseQuotient(brick); }

Eigen::Affine3d TsdfGrid::model_from_voxel() const {
  return Eigen::Translation3d(origin) * Eigen::Affine3d(Eigen::UniformScaling<double>(voxel));
}

cl_int4 bricks_of(const TsdfGrid& grid) {
  const Eigen::Vector3i bricks = grid.bricks();
  return {{bricks.x(), bricks.y(), bricks.z(), 0}};
}

cl_float16 rows_of(const Eigen::Affine3d& transform) {
  cl_float16 rows = {};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      rows.s[4 * row + column] = static_cast<float>(transform.matrix()(row, column));
  return rows;
}

TsdfGrid grid_before_camera(int resolution, double side, double distance, const TruncationBand& truncation) {
  const double voxel = side / resolution;
  const double first = (voxel - side) / 2;
  return {Eigen::Vector3i::Constant(resolution),
          {first, first, distance + voxel / 2},
          voxel,
          truncation.of(voxel)};
}

TsdfGrid grid_around(const SurfaceMap& seen, int resolution, double margin,
                     const TruncationBand& truncation) {
  std::array<std::vector<float>, 3> values;
  for (std::size_t i = 0; i < seen.window.size(); ++i) {
    const Eigen::Vector3f point = finite_or_none(seen.points(), i);
    if (!(point.z() > 0)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) values[axis].push_back(point[static_cast<int>(axis)]);
  }
  if (values[0].empty())
    throw DataError("there is no point in the first frame that the model could be fitted to");
  Eigen::Vector3d least, greatest;
  for (int axis = 0; axis < 3; ++axis) {
    const Extent extent = extent_of(values[static_cast<std::size_t>(axis)]);
    least[axis] = extent.least;
    greatest[axis] = extent.greatest;
  }
  // A single point has no extent: then the grid has a side of a millimetre, or as long as the band is thick.
  const double shortest = std::max(1.0, 2 * truncation.least) / (1 + 2 * margin);
  const double longest = std::max((greatest - least).maxCoeff(), shortest);
  const double voxel = longest * (1 + 2 * margin) / resolution;
  const Eigen::Vector3d side =
      ((greatest - least).array() + 2 * margin * longest).max(2 * truncation.of(voxel)).matrix();
  const Eigen::Vector3i size = whole_bricks((side / voxel).array() - 1e-6);
  const Eigen::Vector3d middle = (least + greatest) / 2;
  return {size, middle - (size.cast<double>().array() - 1).matrix() * (voxel / 2), voxel,
          truncation.of(voxel)};
}

std::string with_tsdf_grid(std::string_view source) {
  return with_surface_map(std::string(embedded::framework_model_tsdf_grid_cl).append(source));
}

cl::Kernel tsdf_kernel(Device& device, std::string_view source, const std::string& name) {
  static const std::string options =
      fmt::format("-DHALO={} -DNO_DEPTH={:e}f -DBRICK_X={} -DBRICK_Y={} -DBRICK_Z={} -DTILE={} -DSTEPS={}.0f",
                  DepthMap::halo, DepthMap::no_depth, TsdfGrid::brick_width, TsdfGrid::brick_height,
                  TsdfGrid::brick_depth, TsdfGrid::tile, TsdfGrid::steps);
  return device.kernel(source, name, options);
}

}  // namespace pliant
