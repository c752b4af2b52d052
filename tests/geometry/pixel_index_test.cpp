#include "framework/geometry/pixel_index.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(PixelIndex, CoversTheProjectionAndNoMore) {
  Surface surface;
  surface.pixels = {{7, 3}, {4, 5}, {6, 5}};
  surface.points.resize(3, {0, 0, 800});
  const PixelIndex index = index_pixels(surface);
  EXPECT_EQ(index.left, 4);
  EXPECT_EQ(index.top, 3);
  EXPECT_EQ(index.points.width(), 4);
  EXPECT_EQ(index.points.height(), 3);
  EXPECT_EQ(index.points.pixels(), (std::vector<int>{-1, -1, -1, 0, -1, -1, -1, -1, 1, -1, 2, -1}));
}

TEST(PixelIndex, OfNothingIsEmpty) { EXPECT_TRUE(index_pixels({}).points.empty()); }

}  // namespace
}  // namespace pliant
