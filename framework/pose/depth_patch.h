#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// A rectangle of cells of a patch, at least one: columns left to right - 1 of rows top to bottom - 1.
struct CellBox {
  std::uint8_t left = 0;
  std::uint8_t top = 0;
  std::uint8_t right = 1;
  std::uint8_t bottom = 1;
};

/// What surrounds a point of a depth map, as the trees of a HeadForest look at it: a square of 160 mm, whatever
/// the point's depth. It is upright in the image and cut into cells, each the depth of one pixel beyond that
/// of the point. Holes, what is outside of the image, and whatever is further behind than a head is deep
/// count alike, so that the background plays no part. Kept as an integral image, so that the mean over any
/// box costs the same.
class DepthPatch {
 public:
  static constexpr int cells = 32;        ///< in each direction
  static constexpr float cell_size = 5;   ///< mm
  static constexpr float reach = 150;     ///< mm that a cell counts as nearer or farther than the point, at most

  /// Around pixel (u, v), which has depth.
  DepthPatch(const DepthImage& depth, const Camera& camera, int u, int v);

  /// Mean depth of the cells of a box, mm; the same offset to all means of a patch is left in.
  float mean(const CellBox& box) const {
    const std::int32_t sum = at(box.right, box.bottom) - at(box.left, box.bottom) - at(box.right, box.top) +
                             at(box.left, box.top);
    const int area = (box.right - box.left) * (box.bottom - box.top);
    return static_cast<float>(sum) / static_cast<float>(area * steps);
  }

 private:
  static constexpr int steps = 8;  // of a mm that depths are rounded to: sums of integers are exact
  static constexpr int row = cells + 1;

  std::int32_t at(int column, int line) const { return sums_[static_cast<std::size_t>(line * row + column)]; }

  std::array<std::int32_t, std::size_t{row} * row> sums_;
};

}  // namespace pliant
