#include "framework/model/tsdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "framework/core/error.h"
#include "tests/model/ball.h"

namespace pliant {
namespace {

using test::Ball;

const Camera kCamera{100, 96, 42.5, 30, 87, 61};
const Ball kBall{.wall = 720};
const TsdfGrid kGrid{{64, 64, 64}, {-150, -150, 480}, 5, 22};
const Eigen::Isometry3d kStart = Eigen::Isometry3d::Identity();

std::vector<Eigen::Vector3f> seen_points(Tsdf& tsdf, const Eigen::Isometry3d& pose = kStart) {
  std::vector<Eigen::Vector3f> points = unflatten(tsdf.raycast(kCamera, whole_image(kCamera), pose).points());
  std::erase_if(points, [](const Eigen::Vector3f& point) { return !(point.z() > 0); });
  return points;
}

TEST(Tsdf, SeesNothingBeforeTheFirstFrame) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  EXPECT_TRUE(seen_points(tsdf).empty());
  EXPECT_TRUE(tsdf.mesh().triangles.empty());
  EXPECT_TRUE(tsdf.raycast(kCamera, {}, kStart).points().empty());
}

TEST(Tsdf, LearnsNothingFromFramesWithoutDepth) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  tsdf.integrate(DepthMap(Frame{}), kCamera, kStart);
  DepthMap holes(whole_image(kCamera));
  std::fill(holes.depth.write_host().begin(), holes.depth.write_host().end(), DepthMap::no_depth);
  tsdf.integrate(holes, kCamera, kStart);
  EXPECT_TRUE(seen_points(tsdf).empty());
}

TEST(Tsdf, ForgetsWhatItWasTold) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  const DepthMap map(kBall.frame(kCamera, kStart));
  tsdf.integrate(map, kCamera, kStart);
  const TsdfVoxels once = tsdf.read();
  const auto points = seen_points(tsdf);
  tsdf.integrate(map, kCamera, kStart);
  tsdf.clear();
  EXPECT_TRUE(seen_points(tsdf).empty());
  tsdf.integrate(map, kCamera, kStart);
  EXPECT_TRUE(tsdf.read().weights == once.weights);
  EXPECT_EQ(seen_points(tsdf), points);
}

TEST(Tsdf, WearsAwayWhatIsNoLongerThere) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  const Ball near{.radius = 0, .wall = 560};
  const Ball far{.radius = 0, .wall = 700};
  tsdf.integrate(DepthMap(near.frame(kCamera, kStart)), kCamera, kStart);
  for (int frame = 0; frame < 3; ++frame)
    tsdf.integrate(DepthMap(far.frame(kCamera, kStart)), kCamera, kStart);
  const auto points = seen_points(tsdf);
  ASSERT_GT(points.size(), 1500U);
  for (const Eigen::Vector3f& point : points) EXPECT_NEAR(point.z(), 700, 0.5);
}

TEST(Tsdf, ClosesNoWallBetweenWhatIsKnownAndWhatIsNot) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  tsdf.integrate(DepthMap(kBall.frame(kCamera, kStart)), kCamera, kStart);
  const Mesh mesh = tsdf.mesh();
  ASSERT_GT(mesh.triangles.size(), 1000U);
  double worst = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d v = vertex.cast<double>();
    const double ball = std::abs((v - kBall.centre).norm() - kBall.radius);
    worst = std::max(worst, std::min(ball, std::abs(v.z() - kBall.wall)));
  }
  EXPECT_LT(worst, kGrid.voxel);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(triangle[k])]; };
    const Eigen::Vector3f normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    EXPECT_LT(normal.dot(corner(0)), 0) << "from outside, where the camera is, corners are counter-clockwise";
  }
}

TEST(Tsdf, AsksForNoMemoryAfterTheFirstFrame) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  const DepthMap map(kBall.frame(kCamera, kStart));
  const auto frame = [&] {
    tsdf.integrate(map, kCamera, kStart);
    tsdf.raycast(kCamera, whole_image(kCamera), kStart);
  };
  frame();
  const DeviceCounts before = device.counts();
  for (int i = 0; i < 20; ++i) frame();
  const DeviceCounts after = device.counts();
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.uploads, before.uploads);
  EXPECT_EQ(after.reads, before.reads);
}

TEST(Tsdf, HasRoomForTheFinestGridInAGibibyte) {
  Device device;
  Tsdf tsdf(device, grid_before_camera(512, 400, 480, {5}), 64);
  tsdf.integrate(DepthMap(kBall.frame(kCamera, kStart)), kCamera, kStart);
  EXPECT_GT(seen_points(tsdf).size(), 300U);
  EXPECT_LT(device.counts().allocated_bytes, std::uint64_t{1} << 29);
}

// The simulator runs this one.
TEST(Tsdf, SeesWithFewPixelsAndVoxels) {
  const Camera camera{20, 20, 9.5, 7.5, 19, 15};
  const TsdfGrid grid{{32, 32, 32}, {-155, -155, 490}, 10, 40};
  Device device;
  Tsdf tsdf(device, grid, 64);
  for (const double degrees : {0.0, 20.0}) {
    const Eigen::Isometry3d pose = kBall.from_around(degrees, {0, 1, 0});
    tsdf.integrate(DepthMap(kBall.frame(camera, pose)), camera, pose);
    const auto points = unflatten(tsdf.raycast(camera, {3, 2, 15, 13}, pose).points());
    EXPECT_GT(std::count_if(points.begin(), points.end(), [](const auto& point) { return point.z() > 0; }),
              15);
  }
}

TEST(Tsdf, SaysWhatTheDeviceHasNoRoomFor) {
  Device device;
  const int side = 1 << 13;  // a terabyte
  EXPECT_THROW(Tsdf(device, grid_before_camera(side, 3000, 500, {5}), 64), DeviceError);
}

TEST(Tsdf, RefusesPosesThatAreNotFinite) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  Eigen::Isometry3d pose = kStart;
  pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(tsdf.integrate(DepthMap(kBall.frame(kCamera, kStart)), kCamera, pose), NumericalError);
  EXPECT_THROW(tsdf.raycast(kCamera, whole_image(kCamera), pose), NumericalError);
}

}  // namespace
}  // namespace pliant
