#include "framework/model/tsdf.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/core/error.h"
#include "framework/geometry/marching_cubes.h"
#include "framework/model/tsdf_fuse.cl.embed.h"
#include "framework/model/tsdf_raycast.cl.embed.h"

namespace pliant {
namespace {

constexpr std::size_t work_group = 64;      // work-items of kernels over bricks, tiles or pixels
constexpr std::size_t fusing_groups = 512;  // that take turns at the bricks to be fused

void check(const Eigen::Isometry3d& pose) {
  if (!pose.matrix().allFinite()) throw NumericalError("the pose of the camera to the model is not finite");
}

std::size_t brick_count(const TsdfGrid& grid) { return grid.bricks().cast<std::size_t>().prod(); }

std::size_t tiles_over(const PixelWindow& window) {
  const auto along = [](int pixels) {
    return static_cast<std::size_t>((pixels + TsdfGrid::tile - 1) / TsdfGrid::tile);
  };
  return along(window.width) * along(window.height);
}

/// The whole tiles of the image that a window meets: so the window says nothing of where rays begin.
PixelWindow whole_tiles(const PixelWindow& window) {
  const auto first = [](int pixel) { return pixel / TsdfGrid::tile * TsdfGrid::tile; };
  const auto last = [&](int end) { return first(end + TsdfGrid::tile - 1); };
  const int left = first(window.left);
  const int top = first(window.top);
  return {left, top, last(window.left + window.width) - left, last(window.top + window.height) - top};
}

cl_int4 as_argument(const PixelWindow& window) {
  return {{window.left, window.top, window.width, window.height}};
}

}  // namespace

Tsdf::Tsdf(Device& device, const TsdfGrid& grid, int max_weight)
    : device_(device),
      grid_(grid),
      max_weight_(max_weight),
      distances_(device.allocate(sizeof(cl_short) * grid.voxels())),
      weights_(device.allocate(sizeof(cl_uchar) * grid.voxels())),
      contents_(device.allocate(sizeof(cl_int) * brick_count(grid))),
      found_(device.allocate(sizeof(cl_int) * (1 + brick_count(grid)))),
      view_({}, {}, {}) {
  clear();
}

void Tsdf::clear() {
  device_.fill_zero(distances_, sizeof(cl_short) * grid_.voxels());
  device_.fill_zero(weights_, sizeof(cl_uchar) * grid_.voxels());
  device_.fill_zero(contents_, sizeof(cl_int) * brick_count(grid_));
}

void Tsdf::integrate(const DepthMap& depth, const Camera& camera, const Eigen::Isometry3d& camera_from_model,
                     int weight) {
  fuse(depth, camera, camera_from_model, weight, nullptr);
}

void Tsdf::integrate(const DepthMap& depth, const Camera& camera, const Eigen::Isometry3d& camera_from_model,
                     const DisplacementLattice& lattice) {
  fuse(depth, camera, camera_from_model, 1, &lattice);
}

void Tsdf::fuse(const DepthMap& depth, const Camera& camera, const Eigen::Isometry3d& camera_from_model,
                int weight, const DisplacementLattice* lattice) {
  check(camera_from_model);
  const PixelWindow& window = depth.window;
  if (window.size() == 0) return;
  const cl_float16 placing = rows_of(camera_from_model * grid_.model_from_voxel());
  const auto truncation = static_cast<float>(grid_.truncation);
  const auto stride = static_cast<cl_int>(depth.stride);
  const std::size_t tiles = tiles_over(window);
  bounds_.make_room(2 * tiles);
  static const std::string fusing = with_lattice(embedded::framework_model_tsdf_fuse_cl);
  auto bound = tsdf_kernel(device_, fusing, "bound_depth");
  auto find = tsdf_kernel(device_, fusing, lattice ? "find_displaced_bricks" : "find_bricks");
  auto fusion = tsdf_kernel(device_, fusing, lattice ? "fuse_displaced" : "fuse");
  const Buffer& seen = depth.depth.device(device_);
  device_.run("integrate", bound, tiles, work_group, seen, stride, as_argument(window),
              bounds_.write_device(device_), found_);
  const auto find_bricks = [&](const auto&... more) {
    device_.run("integrate", find, brick_count(grid_), work_group, bricks_of(grid_), placing, pinhole(camera),
                as_argument(window), truncation, bounds_.device(device_), contents_, found_, more...);
  };
  const auto items = static_cast<std::size_t>(device_.work_group_size());
  const auto fuse_bricks = [&](const auto&... more) {
    device_.run("integrate", fusion, fusing_groups * items, items, found_, bricks_of(grid_), placing,
                pinhole(camera), as_argument(window), stride, truncation, static_cast<float>(weight),
                static_cast<float>(max_weight_), seen, distances_, weights_, contents_, more...);
  };
  if (lattice) {
    find_bricks(lattice->reaches().device(device_));
    fuse_bricks(lattice->displacements().device(device_));
  } else {
    find_bricks();
    fuse_bricks();
  }
}

const SurfaceMap& Tsdf::raycast(const Camera& camera, const PixelWindow& window,
                                const Eigen::Isometry3d& camera_from_model) {
  check(camera_from_model);
  view_.camera = camera;
  view_.window = window;
  if (view_.points().size() != 3 * window.size())
    view_.map = {Array<float>(3 * window.size()), Array<float>(3 * window.size())};
  if (window.size() == 0) return view_;
  const PixelWindow area = whole_tiles(window);
  const std::size_t tiles = tiles_over(area);
  ranges_.make_room(2 * tiles);
  const Eigen::Affine3d camera_from_voxel = camera_from_model * grid_.model_from_voxel();
  const cl_float16 back = rows_of(camera_from_voxel);
  static const std::string casting = with_tsdf_grid(embedded::framework_model_tsdf_raycast_cl);
  auto clear = tsdf_kernel(device_, casting, "clear_ranges");
  auto bound = tsdf_kernel(device_, casting, "bound_rays");
  auto cast = tsdf_kernel(device_, casting, "raycast");
  const Buffer& ranges = ranges_.write_device(device_);
  device_.run("raycast", clear, tiles, work_group, static_cast<cl_int>(tiles), ranges);
  device_.run("raycast", bound, brick_count(grid_), work_group, bricks_of(grid_), contents_, back,
              pinhole(camera), as_argument(area), ranges);
  const auto items = static_cast<std::size_t>(device_.work_group_size());
  device_.run("raycast", cast, tiles * items, items, distances_, bricks_of(grid_), ranges,
              rows_of(camera_from_voxel.inverse()), back, pinhole(camera), as_argument(area),
              as_argument(window), static_cast<float>(grid_.voxel), static_cast<float>(grid_.truncation),
              view_.map.points.write_device(device_), view_.map.normals.write_device(device_));
  return view_;
}

TsdfVoxels Tsdf::read() const {
  TsdfVoxels voxels{std::vector<std::int16_t>(grid_.voxels()), std::vector<std::uint8_t>(grid_.voxels())};
  device_.read(distances_, voxels.distances.data(), sizeof(cl_short) * grid_.voxels());
  device_.read(weights_, voxels.weights.data(), sizeof(cl_uchar) * grid_.voxels());
  return voxels;
}

Mesh Tsdf::mesh() const {
  std::vector<std::int16_t> distances(grid_.voxels());
  device_.read(distances_, distances.data(), sizeof(cl_short) * grid_.voxels());
  const float step = static_cast<float>(grid_.truncation / TsdfGrid::steps);
  return marching_cubes({grid_.size, grid_.origin, grid_.voxel}, [&](int k, std::span<float> values) {
    const std::int16_t* layer = distances.data() + static_cast<std::size_t>(k) * values.size();
    std::transform(layer, layer + values.size(), values.begin(), [&](std::int16_t distance) {
      return distance == 0 ? std::numeric_limits<float>::quiet_NaN() : step * static_cast<float>(distance);
    });
  });
}

}  // namespace pliant
