#include "framework/geometry/pixel_index.h"

#include <gtest/gtest.h>

#include <functional>

namespace pliant {
namespace {

TEST(PixelIndex, CoversTheProjectionAndNoMore) {
  Surface surface;
  surface.pixels = {{7, 3}, {4, 5}, {6, 5}};
  surface.points.resize(3, {0, 0, 800});
  const PixelIndex index = index_pixels(surface);
  EXPECT_EQ(index.window, (PixelWindow{4, 3, 4, 3}));
  EXPECT_EQ(index.count, 3U);
  EXPECT_EQ(index.points.host(), (std::vector<int>{-1, -1, -1, 0, -1, -1, -1, -1, 1, -1, 2, -1}));
}

TEST(PixelIndex, OfNothingIsEmpty) { EXPECT_TRUE(index_pixels({}).points.empty()); }

/// The points of a rectangle of 24x18 pixels from (5, 4) on that are there.
Surface rectangle(const std::function<bool(int, int)>& is_there) {
  Surface surface;
  for (int v = 4; v < 22; ++v)
    for (int u = 5; u < 29; ++u)
      if (is_there(u, v)) surface.pixels.emplace_back(u, v);
  surface.points.resize(surface.pixels.size(), {0, 0, 800});
  return surface;
}

std::vector<std::pair<int, int>> grid_pixels(const Surface& surface, int step) {
  std::vector<std::pair<int, int>> pixels;
  for (const int point : points_on_grid(index_pixels(surface), step)) {
    const Eigen::Vector2i& pixel = surface.pixels[static_cast<std::size_t>(point)];
    pixels.emplace_back(pixel.y(), pixel.x());
  }
  return pixels;
}

using Pixels = std::vector<std::pair<int, int>>;  ///< rows and columns

TEST(PointsOnGrid, AreAtTheCentresOfTheMasks) {
  const Surface dense = rectangle([](int, int) { return true; });
  EXPECT_EQ(grid_pixels(dense, 8),
            (Pixels{{4, 12}, {4, 20}, {4, 28}, {12, 12}, {12, 20}, {12, 28}, {20, 12}, {20, 20}, {20, 28}}));
  EXPECT_EQ(points_on_grid(index_pixels(dense), 1).size(), dense.size());
  EXPECT_TRUE(points_on_grid(index_pixels({}), 8).empty());
}

TEST(PointsOnGrid, AreNoneBesideTheObject) {
  // The centre (4, 12) is above, (12, 28) to the right of what is left; both are next to it.
  const Surface cut = rectangle([](int u, int v) { return v > 4 && u < 28; });
  EXPECT_EQ(grid_pixels(cut, 8), (Pixels{{12, 12}, {12, 20}, {20, 12}, {20, 20}}));
}

TEST(PointsOnGrid, AreTheNearestWhereLinesAreMissing) {
  const Surface striped = rectangle([](int, int v) { return v % 4 != 0; });
  EXPECT_EQ(grid_pixels(striped, 8), (Pixels{{11, 12}, {11, 20}, {11, 28}, {19, 12}, {19, 20}, {19, 28}}))
      << "row 4 has nothing above it";
  const Surface columns = rectangle([](int u, int) { return u % 4 != 0; });
  EXPECT_EQ(grid_pixels(columns, 8), (Pixels{{4, 11}, {4, 19}, {12, 11}, {12, 19}, {20, 11}, {20, 19}}));
}

TEST(PointsOnGrid, AreTheNearestWhereDepthIsSparse) {
  for (const int step : {2, 3, 4}) {
    for (int shift = 0; shift < step; ++shift) {
      const Surface sparse =
          rectangle([&](int u, int v) { return (u + shift) % step == 0 && (v + shift) % step == 0; });
      for (const auto& [v, u] : Pixels{{12, 12}, {12, 20}}) {
        const int point = point_at(index_pixels(sparse), {u, v}, {u - 4, v - 4, u + 4, v + 4});
        ASSERT_GE(point, 0) << step << " " << shift;
        const Eigen::Vector2i away = sparse.pixels[static_cast<std::size_t>(point)] - Eigen::Vector2i(u, v);
        EXPECT_LE(2 * away.cwiseAbs().maxCoeff(), step);
      }
    }
  }
}

TEST(PointsOnGrid, StayInTheirMask) {
  // Of row 12, the only pixels near (12, 12) and (12, 14) are those in between.
  const Surface surface = rectangle([](int u, int v) { return v != 12 || u == 13; });
  const PixelIndex index = index_pixels(surface);
  const int left = point_at(index, {12, 12}, {12, 12, 13, 13});
  EXPECT_EQ(left, -1);
  const int right = point_at(index, {12, 12}, {12, 12, 14, 13});
  ASSERT_GE(right, 0);
  EXPECT_EQ(surface.pixels[static_cast<std::size_t>(right)], Eigen::Vector2i(13, 12));
}

}  // namespace
}  // namespace pliant
