#include "framework/pose/projective_icp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "framework/core/angle.h"
#include "framework/imaging/depth_map.h"
#include "tests/device/shapes.h"
#include "tests/pose/lumpy_object.h"

namespace pliant {
namespace {

using test::camera;
using test::difference;
using test::motion_of;
using test::plane;
using test::seen;
using test::still;
using ::testing::HasSubstr;

SurfaceMap map_of(Device& device, const Frame& frame, const Camera& by = camera) {
  return make_surface_map(device, DepthMap(frame), by);
}

/// A part of a device's lifetime: its kernels are built once.
Device& shared_device() {
  static Device& device = *new Device;
  return device;
}

PoseEstimate track(const Frame& source, const Frame& target, const ProjectiveIcpOptions& options = {},
                   const Camera& by = camera, const Eigen::Isometry3d& start = still) {
  Device& device = shared_device();
  return ProjectiveIcp(device, options)
      .estimate(map_of(device, source, by), map_of(device, target, by), start);
}

// --- one matching ---

class ProjectiveIcpMatching : public testing::TestWithParam<DeviceOptions> {
 protected:
  void expect_alike(const SurfaceMap& source, const SurfaceMap& target, const Eigen::Isometry3d& pose) {
    ProjectiveIcp icp(device, {});
    const RigidEquations found = icp.equations(source, target, pose);
    const RigidEquations expected = projective_equations_reference(source, target, pose, found.pivot,
                                                                   levels_of({}, source.window).back());
    // Rounding may put a point into the next pixel, and a match beyond a limit.
    constexpr double few_pixels = 5e-3;
    EXPECT_EQ(found.samples, expected.samples);
    EXPECT_NEAR(found.landed, expected.landed, 3);
    EXPECT_NEAR(found.matches, expected.matches, 3);
    EXPECT_NEAR(found.squares, expected.squares, few_pixels * expected.squares);
    EXPECT_LT((found.JtJ - expected.JtJ).norm(), few_pixels * expected.JtJ.norm());
    EXPECT_LT((found.Jtr - expected.Jtr).norm(), few_pixels * expected.Jtr.norm());
    EXPECT_GT(expected.matches, expected.samples / 5);
    EXPECT_LT(expected.matches, expected.landed) << "some are rejected";
    EXPECT_LT(expected.landed, expected.samples) << "some meet nothing";
  }

  Device device{"any", GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Shapes, ProjectiveIcpMatching, testing::ValuesIn(test::device_shapes));

TEST_P(ProjectiveIcpMatching, IsThatOfItsReference) {
  expect_alike(map_of(device, seen(still)), map_of(device, seen(motion_of(4, -6, 3, {6, -4, 9}))),
               motion_of(2, -3, 0, {3, 0, 5}));
}

TEST_P(ProjectiveIcpMatching, IsThatOfItsReferenceOfTheWholeImageWithHoles) {
  const SurfaceMap source(camera, make_surface_image(seen(still), camera));
  Frame target = seen(motion_of(0, 5, 0, {2, 0, 4}));
  for (int v = 0; v < camera.height; v += 3)
    for (int u = 0; u < camera.width; u += 2) target.depth(u, v) = 0;
  expect_alike(source, map_of(device, target), motion_of(0, 3, 0, {2, 0, 1}));
}

TEST_P(ProjectiveIcpMatching, TakesNothingThatIsNotFinite) {
  SurfaceMap source = map_of(device, seen(still));
  SurfaceMap target = map_of(device, seen(motion_of(0, 3, 0, {0, 0, 3})));
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       1e30F};
  for (SurfaceMap* map : {&source, &target}) {
    auto& points = map->map.points.write_host();
    auto& normals = map->map.normals.write_host();
    for (std::size_t pixel = 0; pixel < points.size() / 3; pixel += 7) {
      points[3 * pixel + pixel % 3] = bad[pixel % 2];
      normals[3 * ((pixel + 3) % (points.size() / 3))] = bad[pixel % 3];
    }
  }
  expect_alike(source, target, still);
}

// --- whole estimates ---

class ProjectiveIcpEstimate : public testing::TestWithParam<DeviceOptions> {};

INSTANTIATE_TEST_SUITE_P(Shapes, ProjectiveIcpEstimate, testing::ValuesIn(test::device_shapes));

TEST_P(ProjectiveIcpEstimate, IsThatOfItsReference) {
  Device device("any", GetParam());
  const SurfaceMap source = map_of(device, seen(still));
  const SurfaceMap target = map_of(device, seen(motion_of(3, -4, 2, {8, -5, 12})));
  const Eigen::Isometry3d start = motion_of(1, 0, 0, {1, 0, 0});
  const PoseEstimate found = ProjectiveIcp(device, {}).estimate(source, target, start);
  const PoseEstimate expected = projective_icp_reference(source, target, start, {});
  EXPECT_FALSE(found.failed) << found.reason;
  EXPECT_LT(difference(found.target_from_source, expected.target_from_source), 0.05);
  EXPECT_EQ(found.samples, expected.samples);
  EXPECT_NEAR(found.landed, expected.landed, 0.005 * expected.landed);
  EXPECT_NEAR(found.inliers, expected.inliers, 0.005 * expected.inliers);
  EXPECT_NEAR(found.mean_error, expected.mean_error, 0.01);
  EXPECT_NEAR(found.conditioning, expected.conditioning, 0.01 * expected.conditioning);
  EXPECT_EQ(found.weak_directions, expected.weak_directions);
}

TEST(ProjectiveIcp, FindsMotionsFromFrameToFrame) {
  for (const Eigen::Isometry3d& motion :
       {motion_of(0, 0, 0, {30, 0, 0}), motion_of(0, 0, 0, {0, -20, 22}), motion_of(5, 0, 0, {0, 0, 0}),
        motion_of(0, -5, 0, {10, 10, 0}), motion_of(0, 0, 5, {0, 0, -30}),
        motion_of(-3, 3, -3, {15, 15, 15})}) {
    const PoseEstimate estimate = track(seen(still), seen(motion));
    EXPECT_FALSE(estimate.failed) << estimate.reason;
    EXPECT_LT(difference(estimate.target_from_source, motion), 0.5);
    EXPECT_GT(estimate.inliers, 0.85 * estimate.samples);
    EXPECT_GT(estimate.conditioning, 1e-3);
    EXPECT_EQ(estimate.weak_directions, 0);
  }
}

TEST(ProjectiveIcp, StaysWhereItIsRight) {
  const PoseEstimate estimate = track(seen(still), seen(still));
  EXPECT_LT(difference(estimate.target_from_source, still), 0.01);
  EXPECT_LT(estimate.mean_error, 1e-3);
  EXPECT_EQ(estimate.inliers, estimate.landed);
}

/// Few enough for a simulator of devices.
TEST(ProjectiveIcp, FindsMotionsOfAFewPixels) {
  const Camera small{65, 65, 19.5, 14.5, 40, 30};
  const Eigen::Isometry3d motion = motion_of(2, -3, 0, {5, 0, 4});
  const PoseEstimate estimate = track(seen(still, small), seen(motion, small), {}, small);
  EXPECT_FALSE(estimate.failed) << estimate.reason;
  EXPECT_LT(difference(estimate.target_from_source, motion), 2);
}

TEST(ProjectiveIcp, SameBits) {
  const Frame source = seen(still);
  const Frame target = seen(motion_of(2, -3, 0, {5, 0, 0}));
  Device first;
  Device second;
  ProjectiveIcp icp(first, {});
  ProjectiveIcp other(second, {});
  const PoseEstimate once = icp.estimate(map_of(first, source), map_of(first, target), still);
  const PoseEstimate twice = icp.estimate(map_of(first, source), map_of(first, target), still);
  const PoseEstimate elsewhere = other.estimate(map_of(second, source), map_of(second, target), still);
  for (const PoseEstimate* estimate : {&twice, &elsewhere}) {
    EXPECT_EQ(once.target_from_source.matrix(), estimate->target_from_source.matrix());
    EXPECT_EQ(once.mean_error, estimate->mean_error);
    EXPECT_EQ(once.conditioning, estimate->conditioning);
    EXPECT_EQ(once.iterations, estimate->iterations);
  }
}

TEST(ProjectiveIcp, WaitsOnceAndAsksForNoMemoryAfterTheFirstFrame) {
  Device device;
  ProjectiveIcp icp(device, {});
  const SurfaceMap source = map_of(device, seen(still));
  const SurfaceMap target = map_of(device, seen(motion_of(0, 2, 0, {0, 0, 0})));
  icp.estimate(source, target, still);
  const DeviceCounts before = device.counts();
  icp.estimate(source, target, still);
  EXPECT_EQ(device.counts().allocations, before.allocations);
  EXPECT_EQ(device.counts().uploads, before.uploads);
  EXPECT_EQ(device.counts().reads, before.reads + 1);
}

// --- where the surface does not tell ---

TEST(ProjectiveIcp, OfAPlaneFindsTheDistanceAndKeepsTheRestAtTheStart) {
  const Eigen::Isometry3d start(Eigen::Translation3d(4, -3, 0) *
                                Eigen::AngleAxisd(2 * degree, Eigen::Vector3d::UnitZ()));
  const PoseEstimate estimate = track(plane(600, 40, 120), plane(606, 40, 120), {}, camera, start);
  EXPECT_FALSE(estimate.failed) << estimate.reason;
  EXPECT_EQ(estimate.weak_directions, 3);
  EXPECT_LT(estimate.conditioning, 1e-5);
  const Eigen::Vector3d moved = estimate.target_from_source * Eigen::Vector3d(0, 0, 600);
  EXPECT_NEAR(moved.z(), 606, 0.1);
  EXPECT_NEAR(moved.x(), 4, 0.5);
  EXPECT_NEAR(moved.y(), -3, 0.5);
  EXPECT_NEAR(Eigen::AngleAxisd(estimate.target_from_source.linear()).angle(), 2 * degree, 0.1 * degree);
}

// --- failures ---

TEST(ProjectiveIcp, OfAFrameOfHolesFails) {
  const PoseEstimate estimate = track(seen(still), Frame{DepthImage(camera.width, camera.height), {}, {}}, {},
                                      camera, motion_of(1, 2, 3, {4, 5, 6}));
  EXPECT_TRUE(estimate.failed);
  EXPECT_THAT(estimate.reason, HasSubstr("points meet a point of the frame, expected 10 %"));
  EXPECT_EQ(estimate.target_from_source.matrix(), motion_of(1, 2, 3, {4, 5, 6}).matrix()) << "the start";
  EXPECT_EQ(estimate.landed, 0);
}

TEST(ProjectiveIcp, OfAnEmptyModelFails) {
  const PoseEstimate estimate = track(Frame{DepthImage(camera.width, camera.height), {}, {}}, seen(still));
  EXPECT_TRUE(estimate.failed);
  EXPECT_EQ(estimate.reason, "the model shows no point");
}

TEST(ProjectiveIcp, OfExtremeMotionFails) {
  for (const Eigen::Isometry3d& motion :
       {motion_of(0, 90, 0, {0, 0, 0}), motion_of(0, 0, 0, {0, 0, 400}), motion_of(60, 0, 60, {60, 0, 0}),
        motion_of(0, 0, 0, {150, 80, 0})}) {
    const PoseEstimate estimate = track(seen(still), seen(motion));
    EXPECT_TRUE(estimate.failed) << estimate.inliers << " of " << estimate.landed << ", "
                                 << estimate.mean_error << " mm, off by "
                                 << difference(estimate.target_from_source, motion);
    EXPECT_FALSE(estimate.reason.empty());
  }
}

TEST(ProjectiveIcp, AStepThatIsTooLargeFails) {
  ProjectiveIcpOptions options;
  options.max_shift = 10;
  const PoseEstimate shifted = track(seen(still), seen(motion_of(0, 0, 0, {15, 0, 10})), options);
  EXPECT_TRUE(shifted.failed);
  EXPECT_EQ(shifted.reason, "it moved by 18 mm, expected 10 mm at most");
  options = {};
  options.max_turn = 2 * degree;
  const PoseEstimate turned = track(seen(still), seen(motion_of(0, 4, 0, {0, 0, 0})), options);
  EXPECT_TRUE(turned.failed);
  EXPECT_EQ(turned.reason, "it turned by 4.0 degrees, expected 2.0 at most");
}

TEST(ProjectiveIcp, WrongIntrinsicsLowerTheQuality) {
  const Frame target = seen(motion_of(0, 8, 0, {5, 0, 0}));
  Camera wrong = camera;
  wrong.fx *= 1.2;
  wrong.fy *= 1.2;
  const PoseEstimate right = track(seen(still), target);
  const PoseEstimate astray = track(seen(still), target, {}, wrong);
  EXPECT_FALSE(right.failed);
  EXPECT_GT(astray.mean_error, 3 * right.mean_error);
}

TEST(ProjectiveIcp, OfAHandfulOfPointsIsAFailureOrFinite) {
  for (const int width : {1, 2, 3, 5}) {
    Frame few{DepthImage(camera.width, camera.height), {}, {}};
    for (int u = 0; u < width; ++u) few.depth(70 + u, 60) = 600;
    const PoseEstimate estimate = track(few, few);
    EXPECT_TRUE(estimate.failed);
    EXPECT_TRUE(estimate.target_from_source.matrix().allFinite());
  }
}

}  // namespace
}  // namespace pliant
