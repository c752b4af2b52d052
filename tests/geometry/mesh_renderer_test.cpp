#include "framework/geometry/mesh_renderer.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "framework/geometry/point_set.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<Eigen::Vector3i>;

const Camera kCamera{182.3, 180.1, 80.2, 59.7, 160, 120};

/// A closed mesh: a sphere that is dented by `dent` mm in many places, `steps` rings of triangles.
struct Ball {
  Points points;
  Triangles triangles;
};

Ball ball(const Eigen::Vector3d& centre, double radius, double dent, int steps) {
  Ball ball;
  const int around = 2 * steps;
  const auto add = [&](double height, double angle) {
    const double turn = std::numbers::pi * height;
    const double r = radius + dent * std::sin(7 * angle) * std::sin(5 * turn);
    ball.points.push_back(centre + r * Eigen::Vector3d(std::sin(turn) * std::cos(angle), -std::cos(turn),
                                                       std::sin(turn) * std::sin(angle)));
  };
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i < around; ++i) add(static_cast<double>(j) / steps, 2 * std::numbers::pi * i / around);
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i;
      const int b = j * around + (i + 1) % around;
      ball.triangles.emplace_back(a, b, a + around);
      ball.triangles.emplace_back(b, b + around, a + around);
    }
  }
  return ball;
}

/// Whether the ray through a pixel passes an edge of the triangle within `reach` pixels.
bool is_near_edge(int u, int v, const Eigen::Vector3i& triangle, const Points& points, double reach) {
  const Eigen::Vector2d pixel(u, v);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d a = kCamera.project(points[static_cast<std::size_t>(triangle[i])]);
    const Eigen::Vector2d b = kCamera.project(points[static_cast<std::size_t>(triangle[(i + 1) % 3])]);
    const double along =
        std::clamp((pixel - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-12), 0.0, 1.0);
    if ((a + along * (b - a) - pixel).norm() < reach) return true;
  }
  return false;
}

class MeshRendererTest : public testing::Test {
 protected:
  MeshView render(const Points& points, const Triangles& triangles, float near = 1) {
    return MeshRenderer(device_, triangles, points.size()).render(flatten(points), kCamera, near);
  }

  Device device_;
};

// The corners of the device's triangles are rounded to 1/4096 of a pixel, so that a pixel may see another
// triangle than the reference does only where the ray passes an edge of one of the two from as near.
TEST_F(MeshRendererTest, SeesWhatTheReferenceSeesButForRaysThroughEdges) {
  constexpr double reach = 2.0 / 4096;
  const Ball dented = ball({10, -5, 600}, 180, 25, 60);
  const MeshView view = render(dented.points, dented.triangles);
  const auto reference = render_mesh(dented.points, dented.triangles, kCamera);
  int seen = 0;
  int others = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * kCamera.width + u;
      const int triangle = view.triangles.host()[i];
      const Fragment& fragment = reference(u, v);
      if (fragment.triangle >= 0) ++seen;
      if (triangle != fragment.triangle) {
        ++others;
        const auto is_near = [&](int index) {
          return index >= 0 &&
                 is_near_edge(u, v, dented.triangles[static_cast<std::size_t>(index)], dented.points, reach);
        };
        EXPECT_TRUE(is_near(triangle) || is_near(fragment.triangle)) << u << ", " << v;
        continue;
      }
      EXPECT_NEAR(view.depth.host()[i], fragment.depth, 2e-3) << u << ", " << v;
      if (triangle < 0) continue;
      EXPECT_NEAR(view.shares.host()[2 * i], fragment.barycentric[1], 2e-4);
      EXPECT_NEAR(view.shares.host()[2 * i + 1], fragment.barycentric[2], 2e-4);
    }
  }
  EXPECT_GT(seen, 5000);
  // About 2 * reach * (length of all edges in the image) of them, here some 100 per 1000 pixels of edge.
  EXPECT_LT(others, seen / 500);
}

// Without what rays through edges see: any ray that enters a closed mesh meets it.
TEST_F(MeshRendererTest, ShowsNothingThroughSharedEdges) {
  const Ball fine = ball({0, 0, 500}, 140, 0, 150);  // triangles of less than a pixel
  const MeshView view = render(fine.points, fine.triangles);
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Eigen::Vector3d ray = kCamera.unproject(u, v, 1).normalized();
      const Eigen::Vector3d centre(0, 0, 500);
      const double distance = (centre - ray.dot(centre) * ray).norm();
      const std::size_t i = static_cast<std::size_t>(v) * kCamera.width + u;
      if (distance < 139.5) {
        EXPECT_GT(view.depth.host()[i], 355) << u << ", " << v;
        EXPECT_LT(view.depth.host()[i], 500) << u << ", " << v;
      } else if (distance > 140.1) {
        EXPECT_EQ(view.depth.host()[i], 0) << u << ", " << v;
      }
    }
  }
}

// Triangles of any size, also through the camera's plane and behind it.
TEST_F(MeshRendererTest, AgreesOnAnySoup) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> side(-400, 400);
  std::uniform_real_distribution<double> depth(-300, 900);
  int others = 0;
  int seen = 0;
  for (int trial = 0; trial < 10; ++trial) {
    Points points;
    Triangles triangles;
    for (int i = 0; i < 30; ++i) points.emplace_back(side(generator), side(generator), depth(generator));
    for (int i = 0; i < 30; i += 3) triangles.emplace_back(i, i + 1, i + 2);
    const MeshView view = render(points, triangles, 50);
    const auto reference = render_mesh(points, triangles, kCamera, 50);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const Fragment& fragment = reference.pixels()[i];
      if (fragment.triangle >= 0) ++seen;
      if (view.triangles.host()[i] != fragment.triangle)
        ++others;
      else {
        EXPECT_NEAR(view.depth.host()[i], fragment.depth, 0.02) << trial << ": " << i;
      }
    }
  }
  EXPECT_GT(seen, 50000);
  EXPECT_LT(others, 30) << "rays through edges, and where triangles pass through each other";
}

TEST_F(MeshRendererTest, TheFirstOfTwoAtTheSameDepthIsSeenAndNoneThatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Points points = {{-900, -900, 600}, {900, -900, 600}, {0, 1800, 600}, {0, 0, nan}};
  EXPECT_EQ(render(points, {{0, 1, 2}, {0, 1, 2}}).triangles.host()[60 * 160 + 80], 0);
  EXPECT_EQ(render(points, {{0, 1, 3}, {2, 1, 0}}).triangles.host()[60 * 160 + 80], 1);
  EXPECT_EQ(render(points, {{0, 1, 3}}).triangles.host()[60 * 160 + 80], -1);
}

TEST_F(MeshRendererTest, GivesTheSameBitsAgain) {
  const Ball dented = ball({0, 0, 450}, 200, 60, 40);
  const MeshView first = render(dented.points, dented.triangles);
  const MeshView second = render(dented.points, dented.triangles);
  EXPECT_EQ(first.triangles.host(), second.triangles.host());
  EXPECT_EQ(first.depth.host(), second.depth.host());
  EXPECT_EQ(first.shares.host(), second.shares.host());
}

TEST_F(MeshRendererTest, SeesTheSameOnDevicesOfOtherShapes) {
  Device other("any", {1, 4, ""});
  const Ball dented = ball({0, 0, 450}, 200, 60, 40);
  const MeshView view = render(dented.points, dented.triangles);
  const MeshView narrow =
      MeshRenderer(other, dented.triangles, dented.points.size()).render(flatten(dented.points), kCamera);
  EXPECT_EQ(view.triangles.host(), narrow.triangles.host());
  EXPECT_EQ(view.depth.host(), narrow.depth.host());
}

TEST_F(MeshRendererTest, InterpolatesWhatVerticesHave) {
  const Ball dented = ball({0, 0, 450}, 200, 30, 20);
  const MeshRenderer renderer(device_, dented.triangles, dented.points.size());
  const Array<float> points = flatten(dented.points);
  const MeshView view = renderer.render(points, kCamera);
  const Array<float> values = renderer.interpolate(view, points);
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * kCamera.width + u;
      const Eigen::Map<const Eigen::Vector3f> value(values.host().data() + 3 * i);
      const Eigen::Vector3d expected = kCamera.unproject(u, v, view.depth.host()[i]);
      EXPECT_LT((value.cast<double>() - expected).norm(), 5e-3) << u << ", " << v;
    }
  }
}

TEST_F(MeshRendererTest, MovesPointsAsTheReferenceDoes) {
  const Ball before = ball({0, 0, 450}, 150, 30, 30);
  const Ball after = ball({60, -10, 500}, 150, 60, 30);
  const Camera other{170, 175, 70, 64, 150, 110};
  const MeshRenderer renderer(device_, before.triangles, before.points.size());
  const MeshView from = renderer.render(flatten(before.points), kCamera);
  const Array<float> points = flatten(after.points);
  const MeshView to = renderer.render(points, other);
  const TrueMotion motion = renderer.move(from, points, to).read(kCamera);
  const auto seen = render_mesh(before.points, before.triangles, kCamera);
  const TrueMotion expected = true_motion(seen, before.triangles, kCamera, after.points, other,
                                          depth_of(render_mesh(after.points, after.triangles, other)));
  int visible = 0;
  int hidden = 0;
  int others = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const bool is_seen = from.triangles.host()[i] >= 0;
    EXPECT_EQ(motion.scene_flow.pixels()[i].allFinite(), is_seen);
    EXPECT_EQ(motion.optical_flow.pixels()[i].allFinite(), is_seen);
    EXPECT_LE(motion.visible.pixels()[i], is_seen ? 1 : 0);
    if (!is_seen || from.triangles.host()[i] != seen.pixels()[i].triangle) continue;
    EXPECT_LT((motion.scene_flow.pixels()[i] - expected.scene_flow.pixels()[i]).norm(), 0.02) << i;
    EXPECT_LT((motion.optical_flow.pixels()[i] - expected.optical_flow.pixels()[i]).norm(), 0.005) << i;
    (expected.visible.pixels()[i] != 0 ? visible : hidden) += 1;
    if (motion.visible.pixels()[i] != expected.visible.pixels()[i]) ++others;
  }
  EXPECT_GT(visible, 3000);
  EXPECT_GT(hidden, 300);
  EXPECT_LT(others, 10) << "where rounding decides";
}

TEST_F(MeshRendererTest, AllocatesNothingAfterTheThirdFrame) {
  const Ball dented = ball({0, 0, 450}, 200, 30, 20);
  const MeshRenderer renderer(device_, dented.triangles, dented.points.size());
  const MeshView first = renderer.render(flatten(dented.points), kCamera);
  std::uint64_t after_third = 0;
  for (int frame = 1; frame <= 10; ++frame) {
    const Array<float> points = flatten(dented.points);
    const MeshView view = renderer.render(points, kCamera);
    renderer.move(first, points, view).read(kCamera);
    if (frame == 3) after_third = device_.counts().allocations;
  }
  EXPECT_EQ(device_.counts().allocations, after_third);
}

TEST_F(MeshRendererTest, RefusesWhatIsNoMesh) {
  EXPECT_THROW(MeshRenderer(device_, {}, 3), std::invalid_argument);
  EXPECT_THROW(MeshRenderer(device_, {{0, 1, 3}}, 3), std::invalid_argument);
  const MeshRenderer renderer(device_, {{0, 1, 2}}, 3);
  EXPECT_THROW(renderer.render(flatten(Points{{0, 0, 1}}), kCamera), std::invalid_argument);
}

// What hides a point from a view, on a plane that leans away.
TEST(IsShown, LooksAtThePlaneOfThePoint) {
  const Eigen::Vector3d normal(1, 0, -1);  // 45 degrees
  const Eigen::Vector3d point(0, 0, 500);
  const Camera camera{100, 100, 20.3, 20.6, 40, 40};
  DepthImage depth(40, 40);
  for (int v = 0; v < 40; ++v)
    for (int u = 0; u < 40; ++u)
      depth(u, v) = static_cast<float>(normal.dot(point) / normal.dot(camera.unproject(u, v, 1)));
  EXPECT_TRUE(is_shown(point, normal, camera, depth));
  EXPECT_TRUE(is_shown(point, -normal, camera, depth)) << "either side";
  EXPECT_TRUE(is_shown(point - Eigen::Vector3d(0, 0, 1.5), normal, camera, depth)) << "a pixel is 5 mm there";
  EXPECT_FALSE(is_shown(point + Eigen::Vector3d(0, 0, 3), normal, camera, depth)) << "behind what is seen";
  EXPECT_FALSE(is_shown(point - Eigen::Vector3d(0, 0, 3), normal, camera, depth)) << "not there";
  EXPECT_FALSE(is_shown({-120, 0, 500}, normal, camera, depth)) << "outside of the image";
  depth(21, 20) = 400;
  EXPECT_FALSE(is_shown(point, normal, camera, depth)) << "one of the four is before it";
  depth(21, 20) = 0;
  EXPECT_TRUE(is_shown(point, normal, camera, depth)) << "a neighbour that sees nothing hides nothing";
  depth(20, 21) = 0;
  EXPECT_FALSE(is_shown(point, normal, camera, depth)) << "its own pixel sees nothing";
}

}  // namespace
}  // namespace pliant
