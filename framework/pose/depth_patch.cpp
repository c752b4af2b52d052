#include "framework/pose/depth_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant {
namespace {

constexpr int size = DepthPatch::cells;
constexpr double cell_around = 5;  // mm
constexpr double cell_of_head = 8;
constexpr float hole = std::numeric_limits<float>::quiet_NaN();

using Pixels = std::array<int, size>;

/// The columns, or rows, of the image that those of a patch look at; -1 outside. `step`: pixels to a cell.
Pixels pixels_of(double centre, double step, int image_size) {
  Pixels pixels;
  for (int i = 0; i < size; ++i) {
    const double pixel = std::floor(centre + (i + 0.5 - size / 2.0) * step + 0.5);
    pixels[static_cast<std::size_t>(i)] = pixel >= 0 && pixel < image_size ? static_cast<int>(pixel) : -1;
  }
  return pixels;
}

}  // namespace

DepthPatch::DepthPatch(const Cells& depths) {
  std::fill_n(sums_.begin(), row, 0);
  for (int j = 0; j < cells; ++j) {
    const float* line = depths.data() + std::size_t(j) * cells;
    const std::int32_t* above = sums_.data() + std::size_t(j) * row;
    std::int32_t* sums = sums_.data() + std::size_t(j + 1) * row;
    std::int32_t sum = sums[0] = 0;
    for (int i = 0; i < cells; ++i) {
      const float beyond = std::isnan(line[i]) ? reach : std::clamp(line[i], -reach, reach);
      sum += static_cast<std::int32_t>((beyond + reach) * steps);
      sums[i + 1] = above[i + 1] + sum;
    }
  }
}

DepthPatch patch_around(const DepthImage& depth, const Camera& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d centre = camera.project(point);
  const auto middle = static_cast<float>(point.z());
  const Pixels columns = pixels_of(centre.x(), cell_around * camera.fx / point.z(), depth.width());
  const Pixels rows = pixels_of(centre.y(), cell_around * camera.fy / point.z(), depth.height());
  DepthPatch::Cells cells;
  std::size_t at = 0;
  for (const int v : rows) {
    for (const int u : columns) {
      const float z = u < 0 || v < 0 ? 0 : depth(u, v);
      cells[at++] = is_depth(z) ? z - middle : hole;
    }
  }
  return DepthPatch(cells);
}

DepthPatch patch_of_head(const std::vector<Eigen::Vector3f>& points,
                         const Eigen::Isometry3d& camera_from_head) {
  constexpr auto scale = static_cast<float>(1 / cell_of_head);
  constexpr float reach = DepthPatch::reach;
  constexpr float middle = size / 2;  // NOLINT(bugprone-integer-division): a whole cell
  const Eigen::Isometry3f head_from_camera = camera_from_head.inverse().cast<float>();
  DepthPatch::Cells sums{};
  DepthPatch::Cells counts{};
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f seen = head_from_camera * point;
    const float column = seen.x() * scale + middle;
    const float line = -seen.y() * scale + middle;
    if (!(column >= 0 && column < size && line >= 0 && line < size && std::abs(seen.z()) <= reach)) continue;
    const auto at = static_cast<std::size_t>(static_cast<int>(line) * size + static_cast<int>(column));
    sums[at] -= seen.z();
    counts[at] += 1;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = counts[i] > 0 ? sums[i] / counts[i] : hole;
  return DepthPatch(sums);
}

}  // namespace pliant
