#include "framework/imaging/depth_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "framework/geometry/surface.h"
#include "tests/device/shapes.h"
#include "tests/geometry/degrees_between.h"
#include "tests/geometry/made_depth.h"

namespace pliant {
namespace {

using test::degrees_between;

/// Width and height are no multiples of a vector.
const Camera kCamera{300, 290, 84.5, 40, 165, 83};

struct Difference {
  double point = 0;  ///< mm
  double angle = 0;  ///< degrees
  int validity = 0;  ///< pixels where only one of both has a normal
  int normals = 0;   ///< pixels where both have one
};

class DeviceSurfaceMap : public testing::TestWithParam<DeviceOptions> {
 protected:
  static Difference compare(const Frame& frame, int radius = default_normal_radius,
                            float depth_step = default_depth_step);
};

INSTANTIATE_TEST_SUITE_P(Shapes, DeviceSurfaceMap, testing::ValuesIn(test::device_shapes));

/// How far the device's map lies from the reference's.
Difference DeviceSurfaceMap::compare(const Frame& frame, int radius, float depth_step) {
  Device device("any", GetParam());
  const SurfaceImage expected = make_surface_image(frame, kCamera, radius, depth_step);
  const SurfaceMap map = make_surface_map(device, DepthMap(frame), kCamera, radius, depth_step);
  Difference worst;
  for (int i = 0; i < kCamera.width * kCamera.height; ++i) {
    const Eigen::Vector2i pixel(i % kCamera.width, i / kCamera.width);
    const Eigen::Vector3f point = finite_or_none(map, map.points(), pixel);
    const Eigen::Vector3f made = finite_or_none(map, map.normals(), pixel);
    const Eigen::Vector3f& normal = expected.normals(pixel.x(), pixel.y());
    worst.point = std::max<double>(worst.point, (point - expected.points(pixel.x(), pixel.y())).norm());
    const bool is_none = made == Eigen::Vector3f(0, 0, 0);
    if (is_none || normal.norm() == 0) {
      worst.validity += is_none && normal.norm() == 0 ? 0 : 1;
      continue;
    }
    ++worst.normals;
    worst.angle = std::max(worst.angle, degrees_between(normal, made));
    EXPECT_NEAR(made.norm(), 1, 1e-5);
  }
  return worst;
}

TEST(DepthMap, TakesFinitePositiveDepthInsideTheMask) {
  Frame frame = made_depth(kCamera);
  frame.depth(3, 1) = std::nanf("");
  frame.depth(4, 1) = std::numeric_limits<float>::infinity();
  frame.depth(5, 1) = -5;
  frame.mask = MaskImage(kCamera.width, kCamera.height, 1);
  frame.mask(6, 1) = 0;
  const DepthMap map(frame);
  DepthImage expected = frame.depth;
  for (int u = 3; u <= 6; ++u) expected(u, 1) = 0;
  EXPECT_EQ(to_image(map, kCamera).pixels(), expected.pixels());
  std::vector<int> pixels;
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u)
      if (expected(u, v) > 0) pixels.push_back(static_cast<int>(map.window.offset(u, v)));
  EXPECT_EQ(pixels_with_depth(map), pixels);
}

TEST(DepthMap, IsAsSmallAsWhatHasDepth) {
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  frame.depth(40, 20) = frame.depth(31, 22) = frame.depth(35, 29) = 700;
  EXPECT_EQ(DepthMap(frame).window, (PixelWindow{31, 20, 10, 10}));
  frame.depth(kCamera.width - 1, kCamera.height - 1) = 700;
  EXPECT_EQ(DepthMap(frame).window, (PixelWindow{31, 20, kCamera.width - 31, kCamera.height - 20}));
  frame.mask = MaskImage(kCamera.width, kCamera.height);
  frame.mask(35, 29) = 1;
  EXPECT_EQ(DepthMap(frame).window, (PixelWindow{35, 29, 1, 1}));
  EXPECT_EQ(to_image(DepthMap(frame), kCamera)(35, 29), 700);
}

TEST(DepthMap, RefusesAMaskOfAnotherSize) {
  Frame frame = made_depth(kCamera);
  frame.mask = MaskImage(2, 2, 1);
  EXPECT_THROW(DepthMap{frame}, std::invalid_argument);
}

TEST(DepthMap, MayBeEmpty) {
  Device device;
  const DepthMap map{Frame{}};
  EXPECT_TRUE(pixels_with_depth(map).empty());
  EXPECT_TRUE(make_surface_map(device, map, Camera{1, 1, 0, 0, 0, 0}).points().empty());
}

TEST_P(DeviceSurfaceMap, AgreesWithTheReference) {
  const Difference worst = compare(made_depth(kCamera));
  EXPECT_LT(worst.point, 1e-3);
  EXPECT_LT(worst.angle, 0.1);
  EXPECT_EQ(worst.validity, 0);
  EXPECT_GT(worst.normals, 10000);
}

TEST_P(DeviceSurfaceMap, AgreesWithTheReferenceForOtherWindows) {
  for (const int radius : {1, 4, max_window_radius}) {
    const Difference worst = compare(made_depth(kCamera), radius, 8);
    EXPECT_LT(worst.angle, 0.1) << radius;
    EXPECT_EQ(worst.validity, 0) << radius;
  }
}

TEST_P(DeviceSurfaceMap, AgreesWithTheReferenceInsideAMask) {
  Frame frame = made_depth(kCamera);
  frame.mask = MaskImage(kCamera.width, kCamera.height);
  for (int v = 20; v < 60; ++v) {
    for (int u = 31; u < 77; ++u) frame.mask(u, v) = 255;
  }
  const Difference worst = compare(frame);
  EXPECT_LT(worst.angle, 0.1);
  EXPECT_EQ(worst.validity, 0);
  EXPECT_GT(worst.normals, 1500);
}

TEST_P(DeviceSurfaceMap, AgreesWithTheReferenceOnASteepPlane) {
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) frame.depth(u, v) = static_cast<float>(1500 / (1 + 0.02 * u));
  }
  const Difference worst = compare(frame);
  EXPECT_LT(worst.angle, 0.1);
  EXPECT_EQ(worst.validity, 0);
}

TEST_P(DeviceSurfaceMap, TooFewOrCollinearNeighboursGiveNoNormal) {
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  for (const auto& [u, v] : {std::pair(50, 50), {51, 50}, {50, 51}}) frame.depth(u, v) = 800;
  for (int u = 90; u < 100; ++u) frame.depth(u, 50) = static_cast<float>(800 + u);
  for (int i = 0; i < 10; ++i) frame.depth(120 + i, 50 + i) = 700;
  for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) frame.depth(u, v) = 800;
  const Difference worst = compare(frame);
  EXPECT_EQ(worst.normals, 4) << "only the square in the corner has a plane";
  EXPECT_EQ(worst.validity, 0);
}

TEST_P(DeviceSurfaceMap, AgreesWithTheReferenceWhereDepthIsSparse) {
  for (const int step : {2, 3, 4, 8, 9}) {
    Frame frame = made_depth(kCamera);
    for (int v = 0; v < kCamera.height; ++v) {
      for (int u = 0; u < kCamera.width; ++u) {
        // Dense at the left, single pixels in the middle, single rows at the right.
        const bool is_kept = u < 40 || (v % step == 0 && (u > 120 || u % step == 0));
        if (!is_kept) frame.depth(u, v) = 0;
      }
    }
    const Difference worst = compare(frame);
    EXPECT_LT(worst.angle, 0.1) << step;
    EXPECT_EQ(worst.validity, 0) << step;
    EXPECT_GT(worst.normals, 2800) << step;
  }
}

TEST_P(DeviceSurfaceMap, GivesTheSameBitsTwice) {
  const Frame frame = made_depth(kCamera);
  Device first("any", GetParam()), second("any", GetParam());
  const SurfaceMap a = make_surface_map(first, DepthMap(frame), kCamera);
  const SurfaceMap b = make_surface_map(second, DepthMap(frame), kCamera);
  EXPECT_EQ(a.points().host(), b.points().host());
  EXPECT_EQ(a.normals().host(), b.normals().host());
}

TEST(PickPoints, MovesWhatItPicks) {
  Device device;
  const PointSet map{Array<float>({0, 0, 0, 1, 2, 3, 4, 5, 6}), Array<float>({0, 0, 0, 1, 0, 0, 0, 0, 1})};
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(10, 20, 30) * Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  const Array<int> pixels({2, 1});
  const PointSet picked = pick_points(device, map, pixels, motion);
  const auto points = unflatten(picked.points);
  const auto normals = unflatten(picked.normals);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_TRUE(points[0].isApprox(Eigen::Vector3f(5, 24, 36), 1e-6F));
  EXPECT_TRUE(points[1].isApprox(Eigen::Vector3f(8, 21, 33), 1e-6F));
  EXPECT_TRUE(normals[0].isApprox(Eigen::Vector3f(0, 0, 1), 1e-6F));
  EXPECT_TRUE(normals[1].isApprox(Eigen::Vector3f(0, 1, 0), 1e-6F));
  const PointSet unmoved = pick_points(device, map, pixels);
  EXPECT_EQ(unmoved.points.host(), (std::vector<float>{4, 5, 6, 1, 2, 3}));
}

}  // namespace
}  // namespace pliant
