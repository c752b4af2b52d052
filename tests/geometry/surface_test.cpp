#include "framework/geometry/surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/geometry/degrees_between.h"

namespace pliant {
namespace {

using test::degrees_between;

const Camera kCamera{525, 530, 79.5, 59.5, 160, 120};

/// A frame whose depth is `depth_of(a, b)` along the ray (a, b, 1).
Frame render(const std::function<double(double, double)>& depth_of) {
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Eigen::Vector3d ray = kCamera.unproject(u, v, 1);
      frame.depth(u, v) = static_cast<float>(depth_of(ray.x(), ray.y()));
    }
  }
  return frame;
}

/// A plane through (0, 0, 800) with the given normal.
Frame render_plane(const Eigen::Vector3d& normal) {
  return render([&](double a, double b) { return 800 * normal.z() / normal.dot(Eigen::Vector3d(a, b, 1)); });
}

TEST(SurfaceImage, PointsAreTheDepthAlongTheRays) {
  const SurfaceImage map = make_surface_image(render([](double, double) { return 700; }), kCamera);
  EXPECT_TRUE(map.points(100, 20).isApprox(kCamera.unproject(100, 20, 700).cast<float>(), 1e-6f));
}

TEST(SurfaceImage, NormalsOfAPlaneAreExactAndFaceTheCamera) {
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0.5, 0.3, -1),
                                           Eigen::Vector3d(-1, 0, -1), Eigen::Vector3d(0, 1.5, -1)}) {
    const Eigen::Vector3d normal = direction.normalized();
    const SurfaceImage map = make_surface_image(render_plane(normal), kCamera);
    double worst = 0;
    for (const auto& found : map.normals.pixels()) worst = std::max(worst, degrees_between(found, normal));
    EXPECT_LT(worst, 0.02) << "limited by the depth's 24 bits";
    EXPECT_NEAR(map.normals(80, 60).norm(), 1, 1e-6);
  }
}

TEST(SurfaceImage, NormalsOfASphereAreWithinADegree) {
  const Eigen::Vector3d centre(0, 0, 800);
  const double radius = 60;
  const Frame frame = render([&](double a, double b) {
    const Eigen::Vector3d ray(a, b, 1);
    const double along = ray.dot(centre) / ray.squaredNorm();
    const double inside = along * along - (centre.squaredNorm() - radius * radius) / ray.squaredNorm();
    return inside > 0 ? along - std::sqrt(inside) : 0;
  });
  const Surface surface = make_surface(make_surface_image(frame, kCamera), {});
  ASSERT_GT(surface.size(), 4000u);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Eigen::Vector3d normal = (surface.points[i].cast<double>() - centre).normalized();
    if (normal.z() > -0.6) continue;  // near the rim the window covers too much of the sphere
    EXPECT_LT(degrees_between(surface.normals[i], normal), 1.0) << surface.pixels[i].transpose();
  }
}

TEST(SurfaceImage, DepthStepsAreNotMixed) {
  const Frame frame = render([](double a, double) { return a < 0 ? 800 : 850; });
  const SurfaceImage map = make_surface_image(frame, kCamera);
  for (int u = 0; u < kCamera.width; ++u) {
    EXPECT_LT(degrees_between(map.normals(u, 60), Eigen::Vector3d{0, 0, -1}), 0.01) << u;
  }
  // The same step counts as one surface when it is allowed to.
  const SurfaceImage mixed = make_surface_image(frame, kCamera, 2, 60);
  EXPECT_GT(degrees_between(mixed.normals(79, 60), Eigen::Vector3d{0, 0, -1}), 30);
}

TEST(SurfaceImage, InvalidDepthIsNoPoint) {
  Frame frame = render([](double, double) { return 800; });
  frame.depth(10, 10) = std::nanf("");
  frame.depth(11, 10) = std::numeric_limits<float>::infinity();
  frame.depth(12, 10) = -5;
  frame.depth(13, 10) = 0;
  const SurfaceImage map = make_surface_image(frame, kCamera);
  for (int u = 10; u <= 13; ++u) {
    EXPECT_EQ(map.points(u, 10), Eigen::Vector3f(0, 0, 0));
    EXPECT_EQ(map.normals(u, 10), Eigen::Vector3f(0, 0, 0));
  }
  EXPECT_LT(degrees_between(map.normals(11, 11), Eigen::Vector3d{0, 0, -1}), 0.01)
      << "its neighbours are not disturbed";
  EXPECT_EQ(make_surface(map, {}).size(), frame.depth.size() - 4);
}

TEST(SurfaceImage, OnlyTheMaskCounts) {
  Frame frame = render([](double, double b) { return b < 0 ? 800 : 810; });
  frame.mask = MaskImage(kCamera.width, kCamera.height);
  for (int v = 0; v < 60; ++v) {
    for (int u = 20; u < 40; ++u) frame.mask(u, v) = 255;
  }
  const SurfaceImage map = make_surface_image(frame, kCamera);
  EXPECT_EQ(map.points(41, 30), Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(make_surface(map, {}).size(), 60u * 20u);
  EXPECT_LT(degrees_between(map.normals(30, 59), Eigen::Vector3d{0, 0, -1}), 0.01)
      << "depth outside the mask took part";
}

TEST(SurfaceImage, TooFewOrCollinearNeighboursGiveNoNormal) {
  Frame frame{DepthImage(kCamera.width, kCamera.height), {}, {}};
  for (const auto& [u, v] : {std::pair(50, 50), {51, 50}, {50, 51}}) frame.depth(u, v) = 800;
  for (int u = 90; u < 100; ++u) frame.depth(u, 50) = 800;
  SurfaceImage map = make_surface_image(frame, kCamera);
  frame.depth(59, 59) = 800;
  map = make_surface_image(frame, kCamera);
  EXPECT_EQ(map.normals(50, 50), Eigen::Vector3f(0, 0, 0)) << "two neighbours within 8 pixels";
  EXPECT_EQ(map.normals(95, 50), Eigen::Vector3f(0, 0, 0)) << "a line";
  EXPECT_GT(map.points(95, 50).z(), 0);
  frame.depth(51, 51) = 800;
  map = make_surface_image(frame, kCamera);
  EXPECT_LT(degrees_between(map.normals(50, 50), Eigen::Vector3d{0, 0, -1}), 0.01) << "three neighbours";
}

TEST(SurfaceImage, SparseDepthHasNormalsFromFurtherAway) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, 0.3, -1).normalized();
  for (const int step : {2, 3, 4, 6, 8}) {
    Frame frame = render_plane(normal);
    for (int v = 0; v < kCamera.height; ++v)
      for (int u = 0; u < kCamera.width; ++u)
        if (u % step != 0 || v % step != 0) frame.depth(u, v) = 0;
    const Surface surface = make_surface(make_surface_image(frame, kCamera), {});
    for (const auto& found : surface.normals) ASSERT_LT(degrees_between(found, normal), 0.02) << step;
  }
}

TEST(SurfaceImage, EmptyInputGivesNothing) {
  const SurfaceImage map = make_surface_image({}, {});
  EXPECT_TRUE(map.points.empty());
  EXPECT_TRUE(map.normals.empty());
  EXPECT_EQ(make_surface(map, {}).size(), 0u);
}

TEST(Surface, ListsPointsInRowMajorOrderWithTheirColors) {
  Frame frame{DepthImage(kCamera.width, kCamera.height), ColorImage(kCamera.width, kCamera.height), {}};
  const std::vector<Eigen::Vector2i> pixels = {{7, 2}, {90, 2}, {3, 5}, {159, 119}};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    frame.depth(pixels[i].x(), pixels[i].y()) = 500;
    frame.color(pixels[i].x(), pixels[i].y()) = {static_cast<std::uint8_t>(i + 1), 0, 9};
  }
  const SurfaceImage map = make_surface_image(frame, kCamera);
  const Surface surface = make_surface(map, frame.color);
  ASSERT_EQ(surface.pixels, pixels);
  ASSERT_EQ(surface.colors.size(), pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_EQ(surface.points[i], map.points(pixels[i].x(), pixels[i].y()));
    EXPECT_EQ(surface.colors[i], (Rgb{static_cast<std::uint8_t>(i + 1), 0, 9}));
  }
  EXPECT_TRUE(make_surface(map, {}).colors.empty());
}

TEST(Surface, ImagesOfDifferentSizeAreRefused) {
  Frame frame = render([](double, double) { return 800; });
  const SurfaceImage map = make_surface_image(frame, kCamera);
  frame.mask = MaskImage(2, 2, 1);
  EXPECT_THROW(make_surface_image(frame, kCamera), std::invalid_argument);
  EXPECT_THROW(make_surface(map, ColorImage(2, 2)), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
