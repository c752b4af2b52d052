#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// Depths in a square, as the trees of a HeadForest look at them: cells, each by so many mm beyond a point in
/// the middle. Holes, and what lies beyond it by more than a head is deep, count alike, so that the
/// background plays no part. Kept as an integral image, so that the mean over any box costs the same.
class DepthPatch {
 public:
  static constexpr int cells = 32;     ///< in each direction
  static constexpr float reach = 150;  ///< mm: a cell counts as no nearer or farther than that
  /// mm beyond the point in the middle, row by row; NaN for holes.
  using Cells = std::array<float, std::size_t{cells} * cells>;

  explicit DepthPatch(const Cells& depths);

  /// Mean depth of the cells of a box, mm; the same offset to all means of a patch is left in.
  float mean(const CellBox& box) const {
    const std::int32_t sum =
        at(box.right, box.bottom) - at(box.left, box.bottom) - at(box.right, box.top) + at(box.left, box.top);
    const int area = (box.right - box.left) * (box.bottom - box.top);
    return static_cast<float>(sum) / static_cast<float>(area * steps);
  }

 private:
  static constexpr int steps = 8;  // of a mm that depths are rounded to: sums of integers are exact
  static constexpr int row = cells + 1;

  std::int32_t at(int column, int line) const { return sums_[static_cast<std::size_t>(line * row + column)]; }

  std::array<std::int32_t, std::size_t{row} * row> sums_;
};

/// What a depth map (mm) shows around a point (mm, camera frame), upright in the image: 160 mm at the point's
/// depth.
DepthPatch patch_around(const DepthImage& depth, const Camera& camera, const Eigen::Vector3d& point);

/// What points (mm, camera frame) show of a head, seen straight from the front if it is where it is said to
/// be: 256 mm around its centre.
DepthPatch patch_of_head(const std::vector<Eigen::Vector3f>& points,
                         const Eigen::Isometry3d& camera_from_head);

}  // namespace pliant
