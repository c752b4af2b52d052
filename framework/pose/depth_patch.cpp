#include "framework/pose/depth_patch.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

using Pixels = std::array<int, DepthPatch::cells>;

/// The columns, or rows, of the image that those of a patch look at; -1 outside.
Pixels pixels_of(int centre, double focal_length, float depth, int size) {
  Pixels pixels;
  for (int i = 0; i < DepthPatch::cells; ++i) {
    const double along = (i + 0.5 - DepthPatch::cells / 2.0) * DepthPatch::cell_size;
    const double pixel = std::floor(centre + along * focal_length / double{depth} + 0.5);
    pixels[static_cast<std::size_t>(i)] = pixel >= 0 && pixel < size ? static_cast<int>(pixel) : -1;
  }
  return pixels;
}

}  // namespace

DepthPatch::DepthPatch(const DepthImage& depth, const Camera& camera, int u, int v) {
  const float centre = depth(u, v);
  const Pixels columns = pixels_of(u, camera.fx, centre, depth.width());
  const Pixels rows = pixels_of(v, camera.fy, centre, depth.height());
  std::fill_n(sums_.begin(), row, 0);
  for (int j = 0; j < cells; ++j) {
    const int image_row = rows[static_cast<std::size_t>(j)];
    const float* line = image_row < 0 ? nullptr : depth.data() + std::size_t(image_row) * depth.width();
    const std::int32_t* above = sums_.data() + std::size_t(j) * row;
    std::int32_t* sums = sums_.data() + std::size_t(j + 1) * row;
    std::int32_t sum = sums[0] = 0;
    for (int i = 0; i < cells; ++i) {
      const int column = columns[static_cast<std::size_t>(i)];
      const float z = line == nullptr || column < 0 ? 0 : line[column];
      const float beyond = is_depth(z) ? std::clamp(z - centre, -reach, reach) : reach;
      sum += static_cast<std::int32_t>((beyond + reach) * steps);
      sums[i + 1] = above[i + 1] + sum;
    }
  }
}

}  // namespace pliant
