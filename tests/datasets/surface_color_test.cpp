#include "experiments/datasets/surface_color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>

namespace pliant {
namespace {

using Kind = SurfaceColor::Kind;

/// Points in a row on a slanted line, and the colours of each kind there.
std::vector<Eigen::Vector3f> line(int count, float step) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i)
    points.push_back(static_cast<float>(i - count / 2) * step * Eigen::Vector3f(1, 0.37F, -0.6F));
  return points;
}

/// Standard deviation of the green channel over many points.
double contrast(const SurfaceColor& color) {
  const auto points = line(4000, 3.1F);
  double sum = 0;
  double squares = 0;
  for (const auto& point : points) {
    const double value = color.color_of(point).g;
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(points.size());
  return std::sqrt(squares / count - sum / count * (sum / count));
}

TEST(SurfaceColor, BelongsToTheMaterialAndTheSeed) {
  const SurfaceColor one(Kind::rich, 1);
  const SurfaceColor same(Kind::rich, 1);
  const SurfaceColor other(Kind::rich, 2);
  int equal = 0;
  for (const auto& point : line(200, 5)) {
    EXPECT_EQ(one.color_of(point), same.color_of(point));
    equal += one.color_of(point) == other.color_of(point) ? 1 : 0;
  }
  EXPECT_LT(equal, 5);
}

TEST(SurfaceColor, IsSmooth) {
  for (const Kind kind : {Kind::rich, Kind::skin}) {
    const SurfaceColor color(kind, 3);
    const auto points = line(4000, 0.05F);
    for (std::size_t i = 1; i < points.size(); ++i)
      EXPECT_LE(std::abs(color.color_of(points[i]).r - color.color_of(points[i - 1]).r), 5);
  }
}

TEST(SurfaceColor, SkinHasAToneAndLittleContrast) {
  const SurfaceColor rich(Kind::rich, 5);
  const SurfaceColor skin(Kind::skin, 5);
  EXPECT_GT(contrast(rich), 15);
  EXPECT_LT(contrast(skin), contrast(rich) / 2.5);
  EXPECT_GT(contrast(skin), 1);
  for (const auto& point : line(1000, 4)) {
    const Rgb color = skin.color_of(point);
    EXPECT_GT(color.r, color.g);
    EXPECT_GT(color.g, color.b);
  }
}

const std::vector<ColorPatch> patches{{{10, -20, 30}, {150, 90, 200}, {20, 30, 40}, 0.8F},
                                      {{60, 0, 0}, {80, 80, 80}, {250, 240, 230}, 1}};

TEST(SurfaceColor, PatchesAreAllOfTheirColourInTheMiddleAndNoneAtTheirBorder) {
  const SurfaceColor plain(Kind::skin, 5);
  const SurfaceColor patched(Kind::skin, 5, patches);
  EXPECT_EQ(patched.color_of({60, 0, 0}), (Rgb{250, 240, 230}));
  EXPECT_EQ(patched.color_of({60, 30, 20}), (Rgb{250, 240, 230})) << "the later patch is on top";
  EXPECT_EQ(patched.color_of({161, -20, 30}), plain.color_of({161, -20, 30}));
  const Rgb partly = patched.color_of({-20, -20, 30});
  EXPECT_NEAR(partly.r, 0.2 * plain.color_of({-20, -20, 30}).r + 0.8 * 20, 1);
}

class SurfaceColorOnDevice : public testing::TestWithParam<int> {};

// Widths of vectors, and a number of pixels that neither divides.
TEST_P(SurfaceColorOnDevice, IsThatOfTheReference) {
  Device device("any", {GetParam(), std::nullopt, ""});
  const Camera camera{1, 1, 0, 0, 37, 29};
  constexpr std::size_t count = 37 * 29;
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> side(-300, 300);
  std::vector<float> rest(3 * count);
  for (float& value : rest) value = side(generator);
  MeshView view{camera, Array<cl_int>(std::vector<cl_int>(count, 0)), {}, {}};
  for (std::size_t i = 0; i < count; i += 3) view.triangles.write_host()[i] = -1;
  const Array<float> points(rest);
  for (const SurfaceColor& color :
       {SurfaceColor(Kind::rich, 9), SurfaceColor(Kind::skin, 9), SurfaceColor(Kind::skin, 9, patches)}) {
    const ColorImage image = read_colors(color.paint(device, view, points), camera);
    for (std::size_t i = 0; i < count; ++i) {
      const Rgb expected =
          i % 3 == 0 ? Rgb{} : color.color_of({rest[3 * i], rest[3 * i + 1], rest[3 * i + 2]});
      EXPECT_NEAR(image.pixels()[i].r, expected.r, 1) << i;
      EXPECT_NEAR(image.pixels()[i].g, expected.g, 1) << i;
      EXPECT_NEAR(image.pixels()[i].b, expected.b, 1) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, SurfaceColorOnDevice, testing::Values(1, 16));

}  // namespace
}  // namespace pliant
