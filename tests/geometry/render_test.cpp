#include "framework/geometry/render.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<Eigen::Vector3i>;

const Camera kCamera{90, 95, 32, 24, 64, 48};  // the principal point is a pixel's centre

Eigen::Vector3d ray_of(int u, int v) { return kCamera.unproject(u, v, 1); }

/// Where a ray meets a triangle, by solving for it directly; unlike the renderer it knows no edges.
struct Meeting {
  double depth = std::numeric_limits<double>::infinity();
  double inside = 0;  ///< the smallest barycentric coordinate: near 0 the answer is not certain
};

Meeting meet(const Eigen::Vector3d& ray, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  Eigen::Matrix3d system;
  system << a - c, b - c, -ray;
  const Eigen::Vector3d solution = system.fullPivLu().solve(-c);
  const double third = 1 - solution[0] - solution[1];
  return {solution[2], std::min({solution[0], solution[1], third})};
}

TEST(RenderMesh, IsExactOnATiltedTriangle) {
  const Points points = {{-151.3, -102.7, 500}, {250.9, -150.1, 900}, {20.3, 160.7, 700}};
  const auto seen = render_mesh(points, {{0, 1, 2}}, kCamera);
  int count = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Meeting meeting = meet(ray_of(u, v), points[0], points[1], points[2]);
      ASSERT_GT(std::abs(meeting.inside), 1e-9) << "the test needs pixels off the edges";
      ASSERT_EQ(seen(u, v).triangle, meeting.inside > 0 ? 0 : -1) << u << ", " << v;
      if (meeting.inside < 0) continue;
      ++count;
      EXPECT_NEAR(seen(u, v).depth, meeting.depth, 1e-9);
      EXPECT_NEAR(seen(u, v).barycentric.sum(), 1, 1e-12);
      const Eigen::Vector3d point = interpolate(seen(u, v), {{0, 1, 2}}, points);
      EXPECT_LT((point - ray_of(u, v) * meeting.depth).norm(), 1e-9);
    }
  }
  EXPECT_GT(count, 500);
}

TEST(RenderMesh, AgreesWithRayCastingOnAnySoup) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> side(-400, 400);
  std::uniform_real_distribution<double> depth(-300, 900);
  for (int trial = 0; trial < 20; ++trial) {
    Points points;
    Triangles triangles;
    for (int i = 0; i < 30; ++i) points.emplace_back(side(generator), side(generator), depth(generator));
    for (int i = 0; i < 30; i += 3) triangles.emplace_back(i, i + 1, i + 2);
    constexpr double kNear = 50;
    const auto seen = render_mesh(points, triangles, kCamera, kNear);
    for (int v = 0; v < kCamera.height; ++v) {
      for (int u = 0; u < kCamera.width; ++u) {
        double nearest = std::numeric_limits<double>::infinity();
        int triangle = -1;
        bool is_certain = true;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
          const Meeting meeting = meet(ray_of(u, v), points[3 * t], points[3 * t + 1], points[3 * t + 2]);
          if (std::abs(meeting.inside) < 1e-7) is_certain = false;
          if (meeting.inside < 0 || meeting.depth < kNear || meeting.depth > nearest) continue;
          nearest = meeting.depth;
          triangle = static_cast<int>(t);
        }
        if (!is_certain) continue;
        ASSERT_EQ(seen(u, v).triangle, triangle) << "trial " << trial << ", pixel " << u << ", " << v;
        if (triangle >= 0) {
          EXPECT_NEAR(seen(u, v).depth, nearest, 1e-6);
        }
      }
    }
  }
}

TEST(RenderMesh, TheNearerOfTwoIsSeenWhateverTheirOrder) {
  const Points points = {{-900, -900, 600}, {900, -900, 600}, {0, 1800, 600},
                         {-900, -900, 500}, {900, -900, 500}, {0, 1800, 500}};
  const Triangles far_first = {{0, 1, 2}, {3, 4, 5}};
  const Triangles near_first = {{3, 4, 5}, {0, 1, 2}};
  EXPECT_EQ(render_mesh(points, far_first, kCamera)(32, 24).triangle, 1);
  EXPECT_EQ(render_mesh(points, near_first, kCamera)(32, 24).triangle, 0);
  const Triangles twice = {{0, 1, 2}, {0, 1, 2}};
  EXPECT_EQ(render_mesh(points, twice, kCamera)(32, 24).triangle, 0);
}

TEST(RenderMesh, BothSidesAreSeen) {
  const Points points = {{-900, -900, 600}, {900, -900, 600}, {0, 1800, 600}};
  for (const auto& triangle : {Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 1)}) {
    const auto seen = render_mesh(points, {triangle}, kCamera);
    EXPECT_EQ(seen(32, 24).triangle, 0);
    EXPECT_NEAR(seen(32, 24).depth, 600, 1e-9);
  }
}

/// A wavy sheet of n x n cells that fills the image; for even waves its vertices lie on pixels' rays.
struct Sheet {
  Points points;
  Triangles triangles;
};

Sheet wavy_sheet(int n, double wave) {
  Sheet sheet;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double u = -2 + (kCamera.width + 3) * i / static_cast<double>(n);
      const double v = -2 + (kCamera.height + 3) * j / static_cast<double>(n);
      const double depth = 600 + wave * std::sin(0.9 * i) * std::cos(0.7 * j);
      sheet.points.push_back(kCamera.unproject(std::round(u), std::round(v), depth));
    }
  }
  const auto index = [n](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      sheet.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
      sheet.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
    }
  }
  return sheet;
}

TEST(RenderMesh, NothingShowsThroughSharedEdges) {
  for (const int n : {3, 11, 22, 48}) {
    const Sheet sheet = wavy_sheet(n, 40);
    const auto seen = render_mesh(sheet.points, sheet.triangles, kCamera);
    for (int v = 0; v < kCamera.height; ++v) {
      for (int u = 0; u < kCamera.width; ++u) EXPECT_GE(seen(u, v).triangle, 0) << u << ", " << v;
    }
  }
}

TEST(RenderMesh, AGroundThatPassesBelowTheCameraIsExact) {
  // A plane 100 mm below the camera that reaches behind it: depth = 100 / slope of the ray.
  const Points points = {{-1e6, 100, -1e6}, {1e6, 100, -1e6}, {0, 100, 1e6}};
  constexpr double kNear = 450;
  const auto seen = render_mesh(points, {{0, 1, 2}}, kCamera, kNear);
  int drawn = 0;
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const double slope = ray_of(u, v).y();
      const double depth = slope > 0 ? 100 / slope : 0;
      ASSERT_EQ(seen(u, v).triangle >= 0, depth >= kNear) << u << ", " << v;
      if (depth < kNear) continue;
      ++drawn;
      EXPECT_NEAR(seen(u, v).depth / depth, 1, 1e-9);
    }
  }
  EXPECT_GT(drawn, 500);
}

TEST(RenderMesh, WhatIsBehindOrBesideIsNotSeen) {
  const Triangles one = {{0, 1, 2}};
  const auto sees_any = [&](const Points& points) {
    const auto seen = render_mesh(points, one, kCamera);
    for (const Fragment& fragment : seen.pixels()) {
      if (fragment.triangle >= 0) return true;
    }
    return false;
  };
  EXPECT_FALSE(sees_any({{-900, -900, -600}, {900, -900, -600}, {0, 1800, -600}}));
  EXPECT_FALSE(sees_any({{9000, 0, 100}, {9900, 0, 100}, {9000, 900, 100}}));
  EXPECT_FALSE(sees_any({{-1e300, 0, 1}, {-2e300, 0, 1}, {-1e300, 1e300, 1}}));
  EXPECT_FALSE(sees_any({{0, 0, 500}, {0, 0, 500}, {0, 0, 500}}));
  EXPECT_TRUE(sees_any({{-900, -900, 600}, {900, -900, 600}, {0, 1800, 600}}));
}

TEST(RenderMesh, AVertexThatIsNotFiniteIsNotDrawnAndAMissingOneIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Points points = {{-900, -900, nan}, {900, -900, 600}, {0, 1800, 600}};
  EXPECT_EQ(render_mesh(points, {{0, 1, 2}}, kCamera)(32, 24).triangle, -1);
  EXPECT_THROW(render_mesh(points, {{0, 1, 3}}, kCamera), std::invalid_argument);
  EXPECT_THROW(render_mesh(points, {{0, -1, 2}}, kCamera), std::invalid_argument);
}

TEST(DepthOf, IsZeroWhereNothingIsSeen) {
  const Points points = {{-100, -100, 600}, {100, -100, 600}, {0, 100, 600}};
  const DepthImage depth = depth_of(render_mesh(points, {{0, 1, 2}}, kCamera));
  EXPECT_FLOAT_EQ(depth(32, 24), 600);
  EXPECT_EQ(depth(0, 0), 0);
}

TEST(SceneFlow, OfARigidMotionIsThatMotion) {
  const Sheet sheet = wavy_sheet(11, 40);
  const Eigen::Affine3d motion =
      Eigen::Translation3d(5, -7, 11) * Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, -1).normalized());
  Points moved;
  for (const auto& point : sheet.points) moved.push_back(motion * point);
  const auto seen = render_mesh(sheet.points, sheet.triangles, kCamera);
  const auto flow = scene_flow(seen, sheet.triangles, sheet.points, moved);
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Eigen::Vector3d point = ray_of(u, v) * seen(u, v).depth;
      EXPECT_LT((flow(u, v).cast<double>() - (motion * point - point)).norm(), 1e-4);
    }
  }
}

TEST(SceneFlow, IsUnknownWhereNothingIsSeen) {
  const Points points = {{-100, -100, 600}, {100, -100, 600}, {0, 100, 600}};
  const Triangles one = {{0, 1, 2}};
  const auto flow = scene_flow(render_mesh(points, one, kCamera), one, points, points);
  EXPECT_EQ(flow(32, 24), Eigen::Vector3f::Zero());
  EXPECT_TRUE(flow(0, 0).array().isNaN().all());
}

}  // namespace
}  // namespace pliant
