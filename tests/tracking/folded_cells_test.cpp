#include "framework/tracking/folded_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/device/shapes.h"

namespace pliant {
namespace {

const Camera kCamera{50, 48, 20.3, 14.7, 41, 31};
const PixelWindow kWindow{4, 3, 31, 24};

/// A wall that looks at the camera.
SurfaceMap made_wall() {
  std::vector<Eigen::Vector3f> points, normals;
  for (int v = kWindow.top; v < kWindow.top + kWindow.height; ++v)
    for (int u = kWindow.left; u < kWindow.left + kWindow.width; ++u)
      points.push_back(kCamera.unproject(u, v, 500 + u).cast<float>());
  normals.assign(points.size(), {0, 0, -1});
  return {kCamera, kWindow, {flatten(points), flatten(normals)}};
}

/// Pointer to the three numbers of a pixel, by column and row of the window.
float* at(Array<float>& vectors, int column, int row) {
  return vectors.write_host().data() + 3 * (row * kWindow.width + column);
}

/// Swaps the points of columns 10 and 11 in four rows.
SurfaceMap folded_wall() {
  SurfaceMap map = made_wall();
  for (int row = 5; row < 9; ++row)
    std::swap_ranges(at(map.map.points, 10, row), at(map.map.points, 11, row), at(map.map.points, 11, row));
  return map;
}

class FoldedCells : public ::testing::TestWithParam<DeviceOptions> {
 protected:
  /// By the device, which must agree with the reference.
  int count(const SurfaceMap& map) {
    const int counted = count_folded_cells(device_, map);
    EXPECT_EQ(counted, count_folded_cells_reference(map));
    return counted;
  }

  Device device_{"any", GetParam()};
};

TEST_P(FoldedCells, AreNoneWhereNothingIsFolded) { EXPECT_EQ(count(made_wall()), 0); }

TEST_P(FoldedCells, AreCountedWhereTwoColumnsAreSwapped) {
  EXPECT_EQ(count(folded_wall()), 5) << "three between swapped rows, one above them and one below";
}

TEST_P(FoldedCells, AreNoneWhereThePointsLookAwayOrHaveNoNormalOrAreNone) {
  for (const auto& [normal, is_there] : std::vector<std::pair<Eigen::Vector3f, bool>>{
           {{0, 0, 1}, true}, {{0, 0, 0}, true}, {{0, 0, -1}, false}}) {
    SurfaceMap map = folded_wall();
    for (int row = 5; row < 9; ++row) {
      for (const int column : {10, 11}) {
        std::copy_n(normal.data(), 3, at(map.map.normals, column, row));
        if (!is_there) std::fill_n(at(map.map.points, column, row), 3, 0.0F);
      }
    }
    EXPECT_EQ(count(map), 0);
  }
}

TEST_P(FoldedCells, AreCountedAlikeInACrumpledView) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> draw(0, 1);
  SurfaceMap map = made_wall();
  auto& points = map.map.points.write_host();
  auto& normals = map.map.normals.write_host();
  for (std::size_t i = 0; i < points.size(); i += 3) {
    points[i] += 12 * draw(random) - 6;
    points[i + 1] += 12 * draw(random) - 6;
    if (draw(random) < 0.1F) std::fill_n(points.begin() + static_cast<std::ptrdiff_t>(i), 3, 0.0F);
    if (draw(random) < 0.1F) normals[i + 2] = 1;
  }
  EXPECT_GT(count(map), 20);
}

TEST_P(FoldedCells, OfNothingAreNone) {
  EXPECT_EQ(count(SurfaceMap(kCamera, PixelWindow{}, no_points(device_, 0))), 0);
}

INSTANTIATE_TEST_SUITE_P(DeviceShapes, FoldedCells, ::testing::ValuesIn(test::device_shapes));

}  // namespace
}  // namespace pliant
