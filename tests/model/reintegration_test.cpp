#include "framework/model/reintegration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/deformation/warp.h"
#include "framework/model/tsdf.h"
#include "tests/device/shapes.h"
#include "tests/model/ball.h"

namespace pliant {
namespace {

using test::Ball;
using Points = std::vector<Eigen::Vector3f>;

// --- drawing ---

const Camera kSmall{50, 48, 20.3, 14.7, 41, 31};
const PixelWindow kWindow{4, 3, 31, 24};

/// A map whose point of a pixel is where `point_of(u, v)` says; (0, 0, 0) for none.
template <class PointOf>
SurfaceMap made_map(const PixelWindow& window, const PointOf& point_of) {
  Points points;
  for (int v = window.top; v < window.top + window.height; ++v)
    for (int u = window.left; u < window.left + window.width; ++u) points.push_back(point_of(u, v));
  return {kSmall, window, {flatten(points), flatten(Points(points.size(), {0, 0, -1}))}};
}

/// A wavy surface with holes before a wall, all of it moved, so that no point is at its pixel any more; the
/// surface has gone before a part of the wall.
Eigen::Vector3f moved_point(int u, int v) {
  if ((7 * u + 3 * v) % 23 == 0) return Eigen::Vector3f::Zero();
  const bool is_wall = u > 20;
  const double z = is_wall ? 900 + 2 * v : 500 + 12 * std::sin(0.4 * u) + 9 * std::cos(0.3 * v);
  const double shift = is_wall ? 0.31 : 4.37;
  return kSmall.unproject(u + shift + 0.3 * std::sin(v), v + 0.43 + 0.3 * std::cos(u), z).cast<float>();
}

class DrawDepth : public ::testing::TestWithParam<DeviceOptions> {
 protected:
  /// Device and reference alike; gives what was drawn, as an image.
  DepthImage expect_agreement(const SurfaceMap& map) {
    DepthMap drawn(map.window), expected(map.window);
    draw_depth(device_, map, drawn);
    draw_depth_reference(map, expected);
    for (std::size_t i = 0; i < expected.depth.size(); ++i)
      EXPECT_NEAR(drawn.depth.host()[i], expected.depth.host()[i], 1e-5 * expected.depth.host()[i]) << i;
    return to_image(drawn, kSmall);
  }

  Device device_{"any", GetParam()};
};

TEST_P(DrawDepth, TheDeviceAgreesWithTheReference) {
  const DepthImage drawn = expect_agreement(made_map(kWindow, moved_point));
  const auto& depths = drawn.pixels();
  EXPECT_GT(std::count_if(depths.begin(), depths.end(), [](float z) { return z > 400 && z < 600; }), 100);
  EXPECT_GT(std::count_if(depths.begin(), depths.end(), [](float z) { return z > 800 && z < 1000; }), 50);
  EXPECT_EQ(std::count_if(depths.begin(), depths.end(), [](float z) { return z >= 600 && z <= 800; }), 0)
      << "nothing is drawn between the surface and the wall";
  EXPECT_NEAR(drawn(23, 14), 500, 25) << "the surface is before the wall here";
}

// Its points are at the corners of the triangles that are drawn, up to rounding: none must fall between them.
TEST_P(DrawDepth, WhatDidNotMoveIsDrawnAsItWas) {
  const auto depth = [](int u, int v) { return 600 + 2.0 * u - 3.0 * v; };
  const SurfaceMap map = made_map(kWindow, [&](int u, int v) -> Eigen::Vector3f {
    return kSmall.unproject(u, v, depth(u, v)).cast<float>();
  });
  DepthMap drawn(kWindow), expected(kWindow);
  draw_depth(device_, map, drawn);
  draw_depth_reference(map, expected);
  for (const DepthImage& image : {to_image(drawn, kSmall), to_image(expected, kSmall)})
    for (int v = kWindow.top + 1; v + 1 < kWindow.top + kWindow.height; ++v)
      for (int u = kWindow.left + 1; u + 1 < kWindow.left + kWindow.width; ++u)
        EXPECT_NEAR(image(u, v), depth(u, v), 0.01) << u << ' ' << v;
}

TEST_P(DrawDepth, WhatIsTornOrHasFewerThanFourCornersIsNotDrawn) {
  const float step = 1.01F * steepest_cell * 500 / static_cast<float>(kSmall.fx);
  const auto drawn_with = [&](float jump) {
    return expect_agreement(made_map(kWindow, [&](int u, int v) -> Eigen::Vector3f {
      if (u == 10 && v == 10) return Eigen::Vector3f::Zero();
      return kSmall.unproject(u + 0.5, v + 0.5, 500 + (u > 20 ? jump : 0)).cast<float>();
    }));
  };
  const DepthImage torn = drawn_with(step);
  const DepthImage whole = drawn_with(0.95F * step);
  EXPECT_EQ(torn(21, 15), 0);
  EXPECT_GT(whole(21, 15), 500);
  for (const int u : {10, 11})
    for (const int v : {10, 11}) EXPECT_EQ(torn(u, v), 0) << "around the hole";
  EXPECT_NEAR(torn(9, 10), 500, 0.01);
}

TEST_P(DrawDepth, PointsBehindTheCameraOrNotFiniteAreNotDrawn) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  const DepthImage drawn = expect_agreement(made_map(kWindow, [&](int u, int v) -> Eigen::Vector3f {
    if (u == 10) return {1, 2, -500};
    if (u == 20) return {unknown, unknown, unknown};
    return kSmall.unproject(u + 0.5, v + 0.5, 500).cast<float>();
  }));
  EXPECT_EQ(drawn(10, 12), 0);
  EXPECT_EQ(drawn(20, 12), 0);
  EXPECT_NEAR(drawn(15, 12), 500, 0.01);
}

TEST_P(DrawDepth, LeavesNothingOfWhatWasDrawnBefore) {
  DepthMap drawn(kWindow);
  draw_depth(device_, made_map(kWindow, moved_point), drawn);
  draw_depth(device_, made_map(kWindow, [](int, int) { return Eigen::Vector3f(0, 0, 0); }), drawn);
  EXPECT_EQ(drawn.depth.host(), std::vector<float>(drawn.depth.size(), DepthMap::no_depth));
  draw_depth(device_, made_map({}, moved_point), drawn = DepthMap(PixelWindow{}));
  EXPECT_TRUE(pixels_with_depth(drawn).empty());
}

INSTANTIATE_TEST_SUITE_P(DeviceShapes, DrawDepth, ::testing::ValuesIn(test::device_shapes));

// --- deforming the model ---

const Camera kCamera{100, 96, 42.5, 30, 87, 61};
const TsdfGrid kGrid{{64, 64, 32}, {-150, -150, 560}, 5, 22};
constexpr double kWall = 620;
const Ball kFlat{.radius = 0, .wall = kWall};
constexpr int kFrames = 10;
/// Turned and away from the model's frame.
const Eigen::Isometry3d kPose = Eigen::Translation3d(12, -9, 25) *
                                Eigen::AngleAxisd(0.12, Eigen::Vector3d(0.4, 1, -0.3).normalized()) *
                                Eigen::Isometry3d::Identity();

class ReintegrationTest : public ::testing::Test {
 protected:
  /// A model that some frames have shown the wall at rest, and that is looked at from kPose.
  std::unique_ptr<Reintegration> flat_model(int weight) {
    auto model = std::make_unique<Reintegration>(
        device_, std::make_unique<Tsdf>(device_, kGrid, Tsdf::greatest_weight), weight);
    const DepthMap map(kFlat.frame(kCamera, kPose));
    for (int frame = 0; frame < kFrames; ++frame) model->integrate(map, kCamera, kPose);
    model->view(kCamera, whole_image(kCamera), kPose);
    return model;
  }

  /// Deforms it so that all of the view moves alike (mm, camera's frame), be that called deformation or not.
  void move(Reintegration& model, const Eigen::Isometry3d& motion, const Eigen::Isometry3d& pose_after) {
    const DeformationStart start = model.start();
    EXPECT_TRUE(start.nodes.empty()) << "any graph will do";
    SurfaceMap moved(start.rest.camera, start.rest.window, no_points(device_, start.rest.window.size()));
    move_points(device_, start.rest.map, motion, moved.map);
    EmbeddedGraph graph;
    graph.positions = {{10, 20, 600}, {-40, 5, 610}, {30, -50, 640}};
    graph.node_points = flatten(graph.positions);
    std::vector<float> affine;
    for (const Eigen::Vector3f& node : graph.positions) {
      Eigen::Matrix<float, 3, 4> form;
      form << (motion.linear() - Eigen::Matrix3d::Identity()).cast<float>(),
          (motion * node.cast<double>()).cast<float>() - node;
      affine.insert(affine.end(), form.data(), form.data() + form.size());
    }
    model.deform({graph, Array<float>(std::move(affine)), moved, 2, kPose, pose_after});
  }

  /// A motion of all of the model in its own frame, as the camera at kPose sees it.
  static Eigen::Isometry3d seen(const Eigen::Isometry3d& in_model) {
    return kPose * in_model * kPose.inverse();
  }

  /// Where along z the model's surface is in its own frame, about its middle: from, to.
  std::pair<double, double> extent(Reintegration& model) {
    double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
    int count = 0;
    for (const Eigen::Vector3f& point :
         unflatten(model.view(kCamera, whole_image(kCamera), kPose).points())) {
      if (!(point.z() > 0)) continue;
      const Eigen::Vector3d p = kPose.inverse() * point.cast<double>();
      if (std::abs(p.x()) > 100 || std::abs(p.y()) > 100) continue;  // voxels end there
      nearest = std::min(nearest, p.z());
      farthest = std::max(farthest, p.z());
      ++count;
    }
    EXPECT_GT(count, 500);
    return {nearest, farthest};
  }

  Device device_;
};

const Eigen::Isometry3d kNearer(Eigen::Translation3d(0, 0, -8));  // mm

TEST_F(ReintegrationTest, BringsTheModelAsFarAsItsWeightSays) {
  for (const int weight : {1, 10, 200}) {
    SCOPED_TRACE(weight);
    const auto model = flat_model(weight);
    move(*model, seen(kNearer), kPose);
    const double expected = kWall - 8.0 * weight / (weight + kFrames);
    const auto [nearest, farthest] = extent(*model);
    EXPECT_NEAR(nearest, expected, 0.3);
    EXPECT_NEAR(farthest, expected, 0.3);
  }
}

TEST_F(ReintegrationTest, WhatIsNotInViewStaysAsItWas) {
  const auto model = flat_model(200);
  model->view(kCamera, {0, 0, 58, 61}, kPose);
  move(*model, seen(kNearer), kPose);
  int moved = 0, stayed = 0;
  for (const Eigen::Vector3f& vertex : model->mesh().vertices) {
    if (std::abs(vertex.x()) > 100 || std::abs(vertex.y()) > 100) continue;
    const double u = kCamera.project(kPose * vertex.cast<double>()).x();
    if (u < 54) moved += std::abs(vertex.z() - (kWall - 7.6)) < 0.5 ? 1 : 0;
    if (u > 62) {
      EXPECT_NEAR(vertex.z(), kWall, 0.3);
      ++stayed;
    }
  }
  EXPECT_GT(moved, 300);
  EXPECT_GT(stayed, 300);
}

TEST_F(ReintegrationTest, FollowedPointsGoAllTheWay) {
  const auto model = flat_model(1);
  EXPECT_TRUE(model->followed().empty());
  const Points points{{-80, 10, 620}, {5, -40, 620}, {60, 33, 620}};
  model->follow(flatten(points));
  EXPECT_EQ(unflatten(model->followed()), points);
  for (const int times : {1, 2}) {
    move(*model, seen(kNearer), kPose);
    const Points moved = unflatten(model->followed());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LT((moved[i] - points[i] + Eigen::Vector3f(0, 0, 8.0F * static_cast<float>(times))).norm(),
                1e-2);
    model->view(kCamera, whole_image(kCamera), kPose);
  }
}

TEST_F(ReintegrationTest, AMotionOfAllOfItIsNoDeformation) {
  const auto model = flat_model(200);
  const Points points{{-80, 10, 620}, {5, -40, 620}, {60, 33, 620}};
  model->follow(flatten(points));
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(4, -3, 6) * Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 0).normalized());
  move(*model, motion, motion * kPose);
  const auto [nearest, farthest] = extent(*model);
  EXPECT_NEAR(nearest, kWall, 0.3);
  EXPECT_NEAR(farthest, kWall, 0.3);
  const Points followed = unflatten(model->followed());
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((followed[i] - points[i]).norm(), 1e-2);
}

TEST_F(ReintegrationTest, GivesTheSameBitsEveryTime) {
  const auto run = [&] {
    const auto model = flat_model(20);
    move(*model, seen(kNearer), kPose);
    return model->view(kCamera, whole_image(kCamera), kPose).points().host();
  };
  EXPECT_EQ(run(), run());
}

// The simulator runs this one.
TEST(Reintegration, DeformsFewPixelsAndVoxels) {
  const Camera camera{20, 20, 9.5, 7.5, 19, 15};
  const Ball wall{.radius = 0, .wall = 600};
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Device device;
  Reintegration model(
      device, std::make_unique<Tsdf>(device, TsdfGrid{{32, 32, 32}, {-155, -155, 490}, 10, 40}, 64), 60);
  model.integrate(DepthMap(wall.frame(camera, pose)), camera, pose);
  const SurfaceMap& view = model.view(camera, {3, 2, 13, 11}, pose);
  SurfaceMap moved(camera, view.window, no_points(device, view.window.size()));
  move_points(device, view.map, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -20)), moved.map);
  EmbeddedGraph graph;
  graph.positions = {{0, 0, 600}};
  graph.node_points = flatten(graph.positions);
  const Array<float> affine(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -20});
  model.follow(flatten(Points{{0, 0, 600}}));
  model.deform({graph, affine, moved, 4, pose, pose});
  EXPECT_NEAR(model.followed().host()[2], 580, 0.01);
  int count = 0;
  for (const Eigen::Vector3f& point : unflatten(model.view(camera, {5, 4, 9, 7}, pose).points())) {
    if (!(point.z() > 0)) continue;
    EXPECT_NEAR(point.z(), 600 - 20.0 * 60 / 61, 0.5);
    ++count;
  }
  EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace pliant
