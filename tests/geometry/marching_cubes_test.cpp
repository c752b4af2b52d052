#include "framework/geometry/marching_cubes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/geometry/mesh_shape.h"

namespace pliant {
namespace {

using test::MeshShape;
using test::shape_of;

/// Samples of a function, with what they are a view of.
struct SampledGrid {
  std::vector<float> values;
  Eigen::Vector3i size;
  Eigen::Vector3d origin;
  double spacing;
  DistanceGrid view() const { return {{size, origin, spacing}, values}; }
};

SampledGrid sampled(const Eigen::Vector3i& size, const Eigen::Vector3d& origin, double spacing,
                    const std::function<double(const Eigen::Vector3d&)>& distance) {
  SampledGrid grid{{}, size, origin, spacing};
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i)
        grid.values.push_back(static_cast<float>(distance(origin + spacing * Eigen::Vector3d(i, j, k))));
    }
  }
  return grid;
}

void expect_closed(const MeshShape& shape) {
  EXPECT_EQ(shape.open_edges, 0);
  EXPECT_EQ(shape.repeated_edges, 0);
  EXPECT_EQ(shape.unused_vertices, 0);
  EXPECT_GT(shape.volume, 0);
  EXPECT_GT(shape.least_height, 0);
}

TEST(MarchingCubes, ASphereIsClosedAndWhereItShouldBe) {
  const Eigen::Vector3d centre(3, -7, 410);
  const double radius = 50;
  const auto distance = [&](const Eigen::Vector3d& p) { return (p - centre).norm() - radius; };
  const Mesh mesh = marching_cubes(sampled({31, 30, 32}, {-57, -66, 351}, 4, distance).view());
  const MeshShape shape = shape_of(mesh);
  expect_closed(shape);
  EXPECT_EQ(shape.euler, 2);
  EXPECT_NEAR(shape.volume / (4.0 / 3 * 3.14159265 * std::pow(radius, 3)), 1, 0.01);
  for (const Eigen::Vector3f& vertex : mesh.vertices) EXPECT_NEAR(distance(vertex.cast<double>()), 0, 0.12);
}

TEST(MarchingCubes, ATorusHasOneHandle) {
  const auto distance = [](const Eigen::Vector3d& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - 40, p.z()) - 15;
  };
  const Mesh mesh = marching_cubes(sampled({40, 40, 14}, {-58.5, -58.5, -20}, 3, distance).view());
  const MeshShape shape = shape_of(mesh);
  expect_closed(shape);
  EXPECT_EQ(shape.euler, 0);
  for (const Eigen::Vector3f& vertex : mesh.vertices) EXPECT_NEAR(distance(vertex.cast<double>()), 0, 0.2);
}

TEST(MarchingCubes, WhateverTheSignsTheSurfaceIsClosed) {
  // Random samples meet every case of a cell beside every case of its neighbour.
  std::mt19937 random(5);
  for (const double share : {0.2, 0.5, 0.8}) {
    SampledGrid grid = sampled({24, 24, 24}, {0, 0, 0}, 1, [&](const Eigen::Vector3d& p) {
      const bool is_border = p.minCoeff() == 0 || p.maxCoeff() == 23;
      const double size = 0.05 + static_cast<double>(random()) / std::mt19937::max();
      const bool is_inside = static_cast<double>(random()) / std::mt19937::max() < share;
      return is_inside && !is_border ? -size : size;
    });
    expect_closed(shape_of(marching_cubes(grid.view())));
  }
}

TEST(MarchingCubes, SamplesOnTheSurfaceMakeNoFlatTriangles) {
  // Of a cube whose sides pass through samples.
  const auto distance = [](const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() - 4; };
  const MeshShape shape = shape_of(marching_cubes(sampled({13, 13, 13}, {-6, -6, -6}, 1, distance).view()));
  expect_closed(shape);
  EXPECT_EQ(shape.euler, 2);
  EXPECT_NEAR(shape.volume, 512, 60) << "less its edges";
}

TEST(MarchingCubes, WhereNothingIsKnownThereIsNoSurface) {
  const auto distance = [](const Eigen::Vector3d& p) {
    if (p.x() > 5) return std::numeric_limits<double>::quiet_NaN();
    return p.norm() - 10;
  };
  const Mesh mesh = marching_cubes(sampled({31, 31, 31}, {-15, -15, -15}, 1, distance).view());
  EXPECT_GT(mesh.triangles.size(), 500U);
  EXPECT_GT(shape_of(mesh).open_edges, 0);
  EXPECT_EQ(shape_of(mesh).repeated_edges, 0);
  for (const Eigen::Vector3f& vertex : mesh.vertices) EXPECT_LE(vertex.x(), 5);
}

TEST(MarchingCubes, AGridWithoutASurfaceOrWithoutSamplesHasNoTriangles) {
  const auto outside = [](const Eigen::Vector3d&) { return 1.0; };
  EXPECT_TRUE(marching_cubes(sampled({5, 5, 5}, {0, 0, 0}, 1, outside).view()).triangles.empty());
  EXPECT_TRUE(marching_cubes(sampled({1, 1, 1}, {0, 0, 0}, 1, outside).view()).triangles.empty());
  EXPECT_TRUE(marching_cubes({}).triangles.empty());
}

TEST(MarchingCubes, ValuesThatDoNotFitTheSizeAreRefused) {
  const std::vector<float> values(26);
  EXPECT_THROW(marching_cubes({{{3, 3, 3}, {0, 0, 0}, 1}, values}), std::invalid_argument);
  EXPECT_THROW(marching_cubes({{{-3, 3, 3}, {0, 0, 0}, 1}, values}), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
