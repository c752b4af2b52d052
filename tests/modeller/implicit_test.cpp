#include "experiments/modeller/implicit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/geometry/mesh_shape.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

std::vector<Point> random_points(int count, double size) {
  std::mt19937 random(3);
  const auto uniform = [&] { return size * (2.0 * random() / std::mt19937::max() - 1); };
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double x = uniform();
    const double y = uniform();
    points.emplace_back(x, y, uniform());
  }
  return points;
}

TEST(Shape, ATubeIsTheUnionOfItsBalls) {
  const Bead from{{-10, 0, 3}, 9};
  const Bead to{{20, 10, -5}, 4};
  const Shape shape = tube({from, to});
  for (const Point& p : random_points(200, 40)) {
    double least = 1e9;
    for (int i = 0; i <= 1000; ++i) {
      const double t = i / 1000.0;
      const Point centre = from.centre + t * (to.centre - from.centre);
      least = std::min(least, (p - centre).norm() - (from.radius + t * (to.radius - from.radius)));
    }
    EXPECT_NEAR(shape.distance(p), least, 0.01);
    if (shape.distance(p) < 0) {
      EXPECT_LT((p - shape.centre).norm(), shape.bound);
    }
  }
}

TEST(Shape, AnEllipsoidIsExactOnItsAxesAndSurface) {
  const Eigen::Matrix3d rotation = turned(20, -30, 50);
  const Point radii(10, 20, 5);
  const Shape shape = ellipsoid({1, 2, 3}, radii, rotation);
  EXPECT_NEAR(shape.distance(Point(1, 2, 3) + rotation * Point(0, 26, 0)), 6, 1e-9);
  for (const Point& p : random_points(50, 1)) {
    const Point on_surface = Point(1, 2, 3) + rotation * radii.cwiseProduct(p.normalized());
    EXPECT_NEAR(shape.distance(on_surface), 0, 1e-9);
  }
}

TEST(Shape, ARoundedBoxIsAsLargeAsItSays) {
  const Shape shape = rounded_box({0, 0, 0}, {10, 20, 30}, 4);
  EXPECT_NEAR(shape.distance({13, 0, 0}), 3, 1e-12);
  EXPECT_NEAR(shape.distance({0, -19, 0}), -1, 1e-12);
  EXPECT_NEAR(shape.distance({10, 20, 30}), 4 * std::sqrt(3) - 4, 1e-12);
}

TEST(Solid, LeavingOutWhatIsFarChangesNothing) {
  // Against the same steps without any bounds.
  const Shape a = ball({0, 0, 0}, 10);
  const Shape b = ellipsoid({12, 3, 0}, {9, 6, 5});
  const Shape c = ball({5, 8, 2}, 4);
  Solid solid;
  solid.add(a, 0).add(b, 5).cut(c, 3);
  for (const Point& p : random_points(500, 30)) {
    const double both = smooth_minimum(a.distance(p), b.distance(p), 5);
    const double expected = -smooth_minimum(-both, c.distance(p), 3);
    if (std::abs(expected) < 2) {
      EXPECT_NEAR(solid.distance(p), expected, 1e-9);
    }
  }
}

TEST(Solid, RaisesAndPressesMoveTheSurfaceByThatMuch) {
  Solid raised;
  raised.add(ball({0, 0, 0}, 50), 0).raise({0, 0, 50}, {10, 10, 30}, 2);
  EXPECT_NEAR(raised.distance({0, 0, 52}), 0, 0.02);
  EXPECT_NEAR(raised.distance({0, 0, -50}), 0, 1e-3);
  Solid pressed;
  pressed.add(ball({0, 0, 0}, 50), 0).press(ball({0, 0, 50}, 20), 3, 5);
  EXPECT_NEAR(pressed.distance({0, 0, 47}), 0, 1e-9);
  EXPECT_NEAR(pressed.distance({50, 0, 0}), 0, 1e-9);
}

TEST(Polygonise, VerticesLieOnTheSurfaceAndAreFinerInFocus) {
  Solid solid;
  solid.add(ball({-20, 0, 0}, 30), 0).add(ball({20, 0, 0}, 25), 10).cut(ball({0, 30, 0}, 15), 5);
  const Mesh even = polygonise(solid, {3});
  const Mesh focused = polygonise(solid, {3, {-50, 0, 0}, 60, {{{-50, 0, 0}, 15, 0.4}}});
  for (const Mesh& mesh : {even, focused}) {
    const auto shape = test::shape_of(mesh);
    EXPECT_EQ(shape.open_edges, 0);
    EXPECT_EQ(shape.repeated_edges, 0);
    EXPECT_EQ(shape.euler, 2);
    EXPECT_GT(shape.volume, 0);
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      ASSERT_NEAR(solid.distance(vertex.cast<double>()), 0, 0.05);
  }
  const auto share_near = [](const Mesh& mesh, const Point& place) {
    double near = 0;
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      near += (vertex.cast<double>() - place).norm() < 15 ? 1 : 0;
    return near / static_cast<double>(mesh.vertices.size());
  };
  EXPECT_GT(share_near(focused, {-50, 0, 0}), 1.4 * share_near(even, {-50, 0, 0}));
}

}  // namespace
}  // namespace pliant
