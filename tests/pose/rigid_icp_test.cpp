#include "framework/pose/rigid_icp.h"

#include <ceres/jet.h>
#include <ceres/rotation.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "framework/core/angle.h"
#include "framework/imaging/depth_map.h"
#include "framework/pose/rigid_equation.h"
#include "tests/device/shapes.h"
#include "tests/pose/lumpy_object.h"

namespace pliant {
namespace {

using test::camera;
using test::difference;
using test::middle;
using test::motion_of;
using test::plane;
using test::seen;

/// A depth image as ICP takes it.
class View {
 public:
  View(Device& device, const Frame& frame, const Camera& by = camera, int stride = 1)
      : map_(make_surface_map(device, DepthMap(frame), by)) {
    std::vector<int> chosen;
    const std::vector<int> all = pixels_with_depth(DepthMap(frame));
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(stride)) chosen.push_back(all[i]);
    pixels_ = Array<int>(std::move(chosen));
  }
  SeenSurface surface() const { return {map_, pixels_}; }
  PointSet& map() { return map_.map; }

 private:
  SurfaceMap map_;
  Array<int> pixels_;
};

// --- one matching ---

/// Of the distance after a turn about the pivot and a shift, as ceres turns points.
TEST(RigidEquation, JacobianIsThatOfTurningAndShifting) {
  using Jet = ceres::Jet<double, 6>;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-100, 100);
  const auto draw = [&] { return Eigen::Vector3d(side(random), side(random), side(random)); };
  for (int round = 0; round < 100; ++round) {
    const Eigen::Vector3d arm = draw();
    const Eigen::Vector3d from_match = draw();
    const Eigen::Vector3d normal = draw().normalized();
    Jet turn[3];
    Jet offset[3];
    Jet n[3];
    for (int i = 0; i < 3; ++i) turn[i] = Jet(0, i);
    const Jet lever[3] = {Jet(arm.x()), Jet(arm.y()), Jet(arm.z())};
    Jet turned[3];
    ceres::AngleAxisRotatePoint(turn, lever, turned);
    for (int i = 0; i < 3; ++i) {
      offset[i] = from_match[i] + turned[i] - arm[i] + Jet(0, 3 + i);
      n[i] = Jet(normal[i]);
    }
    const Jet expected = plane_distance(offset, n);
    double J[6];
    plane_distance_jacobian(arm.data(), normal.data(), J);
    EXPECT_NEAR(plane_distance(from_match.data(), normal.data()), expected.a, 1e-11);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(J[i], expected.v[i], 1e-10) << i;
  }
}

struct Matching {
  RigidEquations device;
  RigidEquations reference;
  TwoWayResidual two_way_device;
  TwoWayResidual two_way_reference;
};

Matching match_both_ways(View& source, View& target, const Eigen::Isometry3d& pose,
                         const RigidIcpOptions& options, const DeviceOptions& shape) {
  Device device("any", shape);
  RigidIcp icp(device, options);
  Matching matching;
  matching.device = icp.equations(source.surface(), target.surface(), pose);
  matching.reference =
      rigid_equations_reference(source.surface(), target.surface(), pose, matching.device.pivot, options);
  matching.two_way_device = icp.residual(source.surface(), target.surface(), pose);
  matching.two_way_reference =
      two_way_residual_reference(source.surface(), target.surface(), pose, matching.two_way_device.cut);
  return matching;
}

/// Rounding may put a point into the next pixel; a few of those change sums by less than this.
constexpr double few_pixels = 5e-3;

void expect_alike(const Matching& matching) {
  const auto& [device, reference, two_way, two_way_reference] = matching;
  EXPECT_NEAR(device.matches, reference.matches, 2);
  EXPECT_NEAR(device.landed, reference.landed, 2);
  EXPECT_NEAR(device.squares, reference.squares, few_pixels * reference.squares);
  EXPECT_LT((device.JtJ - reference.JtJ).norm(), few_pixels * reference.JtJ.norm());
  EXPECT_LT((device.Jtr - reference.Jtr).norm(), few_pixels * reference.Jtr.norm());
  EXPECT_NEAR(two_way.mean, two_way_reference.mean, few_pixels * two_way_reference.mean);
}

class RigidIcpMatching : public testing::TestWithParam<DeviceOptions> {
 protected:
  Device device{"any", GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Shapes, RigidIcpMatching, testing::ValuesIn(test::device_shapes));

TEST_P(RigidIcpMatching, IsThatOfItsReference) {
  View source(device, seen(Eigen::Isometry3d::Identity()), camera, 11);  // few enough to be taken whole
  View target(device, seen(motion_of(4, -6, 3, {6, -4, 9})), camera, 11);
  const Matching matching = match_both_ways(source, target, motion_of(2, -3, 0, {3, 0, 5}), {}, GetParam());
  EXPECT_GT(matching.reference.matches, 100);
  EXPECT_LT(matching.reference.matches, matching.reference.landed) << "some are rejected";
  EXPECT_GT(matching.two_way_reference.mean, 1);
  expect_alike(matching);
}

TEST_P(RigidIcpMatching, IsThatOfItsReferenceWhereSomeLeavesTheViewOrFacesAway) {
  View source(device, seen(Eigen::Isometry3d::Identity()), camera, 11);
  View target(device, seen(motion_of(0, 10, 0, {185, 0, 0})), camera, 11);
  const Matching matching = match_both_ways(source, target, motion_of(0, 50, 0, {195, 0, 0}),
                                            {.max_distance = 60, .max_angle = 60 * degree}, GetParam());
  EXPECT_GT(matching.reference.matches, 50);
  EXPECT_LT(matching.reference.landed, static_cast<int>(source.surface().pixels.size()) * 3 / 4);
  expect_alike(matching);
}

TEST_P(RigidIcpMatching, TakesNothingThatIsNotFinite) {
  View source(device, seen(Eigen::Isometry3d::Identity()), camera, 11);
  View target(device, seen(motion_of(0, 3, 0, {0, 0, 3})), camera, 11);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       1e30F};
  for (View* view : {&source, &target}) {
    auto& points = view->map().points.write_host();
    auto& normals = view->map().normals.write_host();
    for (std::size_t pixel = 0; pixel < points.size() / 3; pixel += 7) {
      points[3 * pixel + pixel % 3] = bad[pixel % 2];
      normals[3 * ((pixel + 3) % (points.size() / 3))] = bad[pixel % 3];
    }
  }
  const Matching matching = match_both_ways(source, target, Eigen::Isometry3d::Identity(), {}, GetParam());
  EXPECT_GT(matching.reference.matches, 100);
  EXPECT_TRUE(matching.device.JtJ.allFinite());
  expect_alike(matching);
}

// --- whole alignments ---

RigidIcpResult align(const Frame& source, const Frame& target, const RigidIcpOptions& options = {},
                     const Camera& by = camera) {
  static Device device;  // its kernels are built once
  return RigidIcp(device, options)
      .align(View(device, source, by).surface(), View(device, target, by).surface(),
             Eigen::Isometry3d::Identity());
}

/// The arguments of motion_of.
struct Turn {
  double x, y, z;
  Eigen::Vector3d shift;
};

void PrintTo(const Turn& turn, std::ostream* out) {
  *out << turn.x << ", " << turn.y << ", " << turn.z << " degrees, " << turn.shift.transpose() << " mm";
}

class FarTurn : public testing::TestWithParam<Turn> {};

TEST_P(FarTurn, IsFound) {
  const auto& [x, y, z, shift] = GetParam();
  const Eigen::Isometry3d motion = motion_of(x, y, z, shift);
  const RigidIcpResult result = align(seen(Eigen::Isometry3d::Identity()), seen(motion));
  EXPECT_FALSE(result.failed) << result.reason;
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_LT(difference(result.pose, motion), 1);
  EXPECT_GT(result.before.mean, 4);
  EXPECT_LT(result.after.mean, 0.5 * result.before.mean);
  EXPECT_GT(result.inliers, result.samples / 2);
  EXPECT_GT(result.conditioning, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(RigidIcp, FarTurn,
                         testing::Values(Turn{30, 0, 0, {0, 0, 0}}, Turn{-30, 0, 0, {0, 0, 0}},
                                         Turn{0, 45, 0, {0, 0, 0}}, Turn{0, -30, 0, {0, 0, 0}},
                                         Turn{0, 0, 30, {0, 0, 0}}, Turn{0, 0, 0, {60, 0, 0}},
                                         Turn{0, 0, 0, {0, -30, 100}}, Turn{20, 20, 0, {30, 20, 40}}));

TEST(RigidIcp, FromTheStartAloneFindsWhatIsNear) {
  RigidIcpOptions options;
  options.search_angle = 0;
  const auto near = motion_of(3, -4, 2, {5, 3, -6});
  EXPECT_LT(difference(align(seen(Eigen::Isometry3d::Identity()), seen(near), options).pose, near), 0.5);
}

TEST(RigidIcp, StaysWhereItIsRight) {
  const Frame frame = seen(Eigen::Isometry3d::Identity());
  const RigidIcpResult result = align(frame, frame);
  EXPECT_LT(difference(result.pose, Eigen::Isometry3d::Identity()), 0.01);
  EXPECT_LT(result.before.mean, 1e-5);
}

/// A bulge of 8 mm on a third of the object, as a puffed cheek.
TEST(RigidIcp, APartThatDeformsDoesNotPullAtTheRest) {
  const auto turn = motion_of(0, 15, 0, {10, 0, 0});
  Frame target = seen(turn);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      if (target.depth(u, v) > 0)
        target.depth(u, v) -=
            static_cast<float>(8 * std::exp(-std::pow((u - 100) / 15.0, 2) - std::pow((v - 70) / 20.0, 2)));
  RigidIcpOptions constant;
  constant.trim = 0;
  const Frame source = seen(Eigen::Isometry3d::Identity());
  const double trimmed = difference(align(source, target).pose, turn);
  EXPECT_LT(trimmed, 1.5);
  EXPECT_LT(trimmed, 0.5 * difference(align(source, target, constant).pose, turn));
}

TEST(RigidIcp, FindsTheSameInEveryShapeOfItsKernels) {
  const Frame source = seen(Eigen::Isometry3d::Identity());
  const Frame target = seen(motion_of(20, 20, 0, {30, 20, 40}));
  const RigidIcpResult expected = align(source, target);
  for (const DeviceOptions& shape : test::device_shapes) {
    Device device("any", shape);
    const RigidIcpResult found = RigidIcp(device, {})
                                     .align(View(device, source).surface(), View(device, target).surface(),
                                            Eigen::Isometry3d::Identity());
    EXPECT_LT(difference(found.pose, expected.pose), 0.05);
    EXPECT_NEAR(found.after.mean, expected.after.mean, 0.01);
    EXPECT_EQ(found.converged, expected.converged);
  }
}

TEST(RigidIcp, SameBits) {
  const Frame source = seen(Eigen::Isometry3d::Identity());
  const Frame target = seen(motion_of(20, -20, 0, {30, 0, 0}));
  Device first;
  Device second;
  RigidIcp icp(first, {});
  const auto run = [&](RigidIcp& with, Device& device) {
    return with.align(View(device, source).surface(), View(device, target).surface(),
                      Eigen::Isometry3d::Identity());
  };
  const RigidIcpResult once = run(icp, first);
  const RigidIcpResult twice = run(icp, first);  // in the same buffers
  RigidIcp other(second, {});
  const RigidIcpResult elsewhere = run(other, second);
  for (const RigidIcpResult* result : {&twice, &elsewhere}) {
    EXPECT_EQ(once.pose.matrix(), result->pose.matrix());
    EXPECT_EQ(once.after.mean, result->after.mean);
    EXPECT_EQ(once.mean_error, result->mean_error);
    EXPECT_EQ(once.iterations, result->iterations);
  }
}

// --- where there is no answer ---

TEST(RigidIcp, OfAPlaneFindsTheDistanceAndSaysThatItMaySlide) {
  const RigidIcpResult result = align(plane(600, 40, 120), plane(620, 40, 120));
  EXPECT_FALSE(result.failed) << result.reason;
  EXPECT_LT(result.conditioning, 1e-6);
  const Eigen::Vector3d moved = result.pose * middle();
  EXPECT_NEAR(moved.z(), 620, 0.1);
  EXPECT_LT(moved.head<2>().norm(), 10) << "it does not slide away";
}

TEST(RigidIcp, WithoutOverlapFailsAndSaysSo) {
  RigidIcpOptions options;
  options.search_angle = 0;
  const RigidIcpResult result = align(plane(600, 10, 60), plane(600, 90, 140), options);
  EXPECT_TRUE(result.failed);
  EXPECT_FALSE(result.converged);
  EXPECT_THAT(result.reason, testing::HasSubstr("0 of 4000 points have a match"));
  EXPECT_TRUE(result.pose.matrix().allFinite());
}

TEST(RigidIcp, OfAnEmptyTargetFails) {
  const RigidIcpResult result = align(plane(600, 10, 60), plane(600, 0, 0));
  EXPECT_TRUE(result.failed);
  EXPECT_TRUE(result.pose.matrix().allFinite());
}

TEST(RigidIcp, OfAHandfulOfPointsIsAFailureOrFinite) {
  for (const int width : {1, 2, 3, 5}) {
    Frame few{DepthImage(camera.width, camera.height), {}, {}};
    for (int u = 0; u < width; ++u) few.depth(70 + u, 60) = 600;
    const RigidIcpResult result = align(few, few);
    EXPECT_TRUE(result.failed || result.pose.matrix().allFinite());
  }
}

}  // namespace
}  // namespace pliant
