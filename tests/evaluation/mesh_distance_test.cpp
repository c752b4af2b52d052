#include "framework/evaluation/mesh_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace pliant {
namespace {

const Eigen::Vector3f a(0, 0, 0), b(10, 0, 0), c(0, 10, 0);

TEST(NearestInTriangle, IsAboveItOrOnItsRim) {
  EXPECT_EQ(nearest_in_triangle({2, 3, 7}, a, b, c), Eigen::Vector3f(2, 3, 0));
  EXPECT_EQ(nearest_in_triangle({4, -3, 1}, a, b, c), Eigen::Vector3f(4, 0, 0));
  EXPECT_EQ(nearest_in_triangle({-1, -1, 0}, a, b, c), a);
  EXPECT_LT((nearest_in_triangle({9, 9, 0}, a, b, c) - Eigen::Vector3f(5, 5, 0)).norm(), 1e-5F);
  EXPECT_EQ(nearest_in_triangle({3, 4, 5}, a, a, a), a) << "also of a point";
}

TEST(MeshDistance, IsExactForTrianglesOfAnySize) {
  // Two walls that meet at a right angle, metres wide, and points around the edge.
  const Mesh corner{{{0, 0, 0}, {4000, 0, 0}, {4000, 3000, 0}, {0, 3000, 0}, {0, 0, 2000}, {0, 3000, 2000}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {0, 5, 4}},
                    {}};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> along(100, 1900);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 200; ++i) points.emplace_back(along(random) / 20, along(random), along(random) / 20);
  const auto distances = MeshDistance(corner, 20).distances(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(distances[i], std::min(points[i].x(), points[i].z()), 0.01F) << points[i].transpose();
}

TEST(MeshDistance, NeedsATriangle) { EXPECT_THROW(MeshDistance(Mesh{}), std::invalid_argument); }

}  // namespace
}  // namespace pliant
