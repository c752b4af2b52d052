#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "framework/core/error.h"
#include "framework/model/reference_model.h"
#include "framework/model/tsdf_grid.h"
#include "tests/model/ball.h"

namespace pliant {
namespace {

using test::Ball;

const Camera kCamera{100, 100, 40, 30, 80, 60};

SurfaceMap seen(Device& device, const Frame& frame) {
  return make_surface_map(device, DepthMap(frame), kCamera);
}

std::unique_ptr<ModelKind> kind(const std::string& volume, std::int64_t resolution) {
  Registry registry;
  register_models(registry);
  return registry.make<ModelKind>(Parameters("tsdf",
                                             {{"resolution", resolution},
                                              {"volume", volume},
                                              {"size", 3000.0},
                                              {"distance", 500.0},
                                              {"margin", 0.25},
                                              {"truncation", 5.0},
                                              {"least_truncation", 10.0},
                                              {"max_weight", std::int64_t{64}}},
                                             "tracked.yaml:3:8"));
}

TEST(TsdfGrid, IsAroundWhatWasSeen) {
  Device device;
  const Ball ball;
  const TsdfGrid grid =
      grid_around(seen(device, ball.frame(kCamera, Eigen::Isometry3d::Identity())), 64, 0.25, {5});
  EXPECT_EQ(grid.size.maxCoeff(), 64);
  EXPECT_EQ(grid.size.x() % TsdfGrid::brick_width, 0);
  EXPECT_LT(grid.size.z(), 64) << "half of the ball is seen";
  const double side = grid.voxel * grid.size.maxCoeff();
  EXPECT_NEAR(side, 1.5 * 2 * ball.radius, 0.1 * side);
  EXPECT_EQ(grid.truncation, 5 * grid.voxel);
  const Eigen::Vector3d end = grid.origin + grid.voxel * (grid.size.cast<double>().array() - 1).matrix();
  EXPECT_NEAR((grid.origin.x() + end.x()) / 2, ball.centre.x(), 3);
  EXPECT_LT(grid.origin.z(), ball.centre.z() - ball.radius - 0.2 * 2 * ball.radius);
  EXPECT_GT(end.z(), ball.centre.z() + 0.1 * 2 * ball.radius);
}

TEST(TsdfGrid, DoesNotWaitForAFewPointsFarOut) {
  Device device;
  const Ball ball;
  Frame frame = ball.frame(kCamera, Eigen::Isometry3d::Identity());
  const TsdfGrid expected = grid_around(seen(device, frame), 64, 0.25, {5});
  frame.depth(0, 0) = frame.depth(79, 59) = 5000;
  const TsdfGrid grid = grid_around(seen(device, frame), 64, 0.25, {5});
  EXPECT_NEAR(grid.voxel, expected.voxel, 0.1 * expected.voxel);
}

TEST(TsdfGrid, IsASmallOneAroundASinglePoint) {
  Device device;
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  frame.depth(7, 9) = 800;
  const TsdfGrid grid = grid_around(seen(device, frame), 32, 0.25, {5});
  EXPECT_GT(grid.voxel, 0);
  EXPECT_NEAR(grid.origin.z(), 800, 1);
}

TEST(TsdfGrid, HasABandOfVoxelsAndOfMillimetresAtLeast) {
  EXPECT_EQ(grid_before_camera(32, 320, 500, {5, 10}).truncation, 50);
  EXPECT_EQ(grid_before_camera(512, 512, 500, {5, 10}).truncation, 10);
  Device device;
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  frame.depth(7, 9) = 800;
  const TsdfGrid grid = grid_around(seen(device, frame), 64, 0.25, {5, 10});
  EXPECT_EQ(grid.truncation, 10);
  EXPECT_EQ(grid.size.maxCoeff(), 64) << "what is thinner than the band takes no more room";
}

TEST(Models, AreFittedOrNot) {
  Device device;
  const SurfaceMap map = seen(device, Ball{.wall = 900}.frame(kCamera, Eigen::Isometry3d::Identity()));
  for (const char* volume : {"scene", "fitted"}) {
    const auto model = kind(volume, 64)->make(device, map);
    const Frame frame = Ball{.wall = 900}.frame(kCamera, Eigen::Isometry3d::Identity());
    model->integrate(DepthMap(frame), kCamera, Eigen::Isometry3d::Identity());
    const auto points =
        unflatten(model->raycast(kCamera, whole_image(kCamera), Eigen::Isometry3d::Identity()).points());
    EXPECT_GT(std::count_if(points.begin(), points.end(), [](const auto& point) { return point.z() > 0; }),
              3000)
        << volume;
  }
}

TEST(Models, SayThatThereIsNothingToFitThemTo) {
  Device device;
  const SurfaceMap nothing = seen(device, Frame{DepthImage(kCamera.width, kCamera.height), {}, {}});
  EXPECT_THROW(kind("fitted", 64)->make(device, nothing), DataError);
  EXPECT_NO_THROW(kind("scene", 64)->make(device, nothing));
}

}  // namespace
}  // namespace pliant
