#include "framework/evaluation/nearest_points.h"

#include <gtest/gtest.h>

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Map = Image<Eigen::Vector3f>;

constexpr float nowhere = std::numeric_limits<float>::infinity();

Camera camera_of(int width, int height) {
  return {0.8 * width, 0.8 * width, (width - 1) / 2.0, (height - 1) / 2.0, width, height};
}

/// A waved surface with holes in it and a step in depth, `further` mm away from where it is at 0.
Map surface(int width, int height, float further, float noise = 0.5F) {
  const Camera camera = camera_of(width, height);
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0, noise);
  Map map(width, height, Eigen::Vector3f::Zero());
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if ((u / 7 + v / 5) % 6 == 0) continue;
      const double wave = 40 * std::sin(8.0 * u / width) * std::cos(6.0 * v / height);
      const double step = 3 * u > 2 * width ? 150 : 0;
      map(u, v) = camera.unproject(u, v, 700 + wave + step + further + normal(random)).cast<float>();
    }
  return map;
}

Points points_of(const Map& map) {
  Points points;
  for (const auto& point : map.pixels())
    if (point.z() > 0) points.push_back(point);
  return points;
}

std::vector<float> by_brute_force(const Map& map, const Points& queries) {
  std::vector<float> found;
  for (const auto& query : queries) {
    float least = nowhere;
    for (const auto& point : map.pixels()) {
      const Eigen::Vector3f away = point - query;
      if (point.z() > 0)
        least = std::min(least, away.x() * away.x() + away.y() * away.y() + away.z() * away.z());
    }
    found.push_back(std::sqrt(least));
  }
  return found;
}

/// The reference: FLANN's single kd-tree, which searches exactly.
std::vector<float> by_flann(const Map& map, Points queries) {
  Points points = points_of(map);
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> tree(
      flann::Matrix<float>(points[0].data(), points.size(), 3));
  tree.buildIndex();
  std::vector<int> nearest(queries.size());
  std::vector<float> squared(queries.size());
  flann::Matrix<int> indices(nearest.data(), queries.size(), 1);
  flann::Matrix<float> distances(squared.data(), queries.size(), 1);
  tree.knnSearch(flann::Matrix<float>(queries[0].data(), queries.size(), 3), indices, distances, 1,
                 flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  for (float& distance : squared) distance = std::sqrt(distance);
  return squared;
}

std::vector<float> by_tree(const Map& map, const Points& queries) {
  return NearestPoints(map, camera_of(map.width(), map.height())).distances(queries);
}

TEST(NearestPoints, AgreesWithFlannToTheBit) {
  const Map map = surface(257, 131, 0);
  for (const float further : {0.0F, 0.7F, 12.0F, 300.0F})
    EXPECT_EQ(by_tree(map, points_of(surface(257, 131, further))),
              by_flann(map, points_of(surface(257, 131, further))))
        << further;
}

TEST(NearestPoints, AgreesWithBruteForceForImagesOfAnySize) {
  const std::pair<int, int> sizes[] = {{1, 1}, {3, 2}, {4, 4}, {5, 17}, {64, 16}, {65, 33}};
  for (const auto& [width, height] : sizes) {
    const Map map = surface(width, height, 0);
    if (points_of(map).empty()) continue;
    const Points queries = points_of(surface(65, 33, 3));
    EXPECT_EQ(by_tree(map, queries), by_brute_force(map, queries)) << width << "x" << height;
  }
  Map single(9, 7, Eigen::Vector3f::Zero());
  single(8, 6) = {1, 2, 3};
  EXPECT_EQ(by_tree(single, {{1, 2, 5}}), std::vector<float>{2});
}

TEST(NearestPoints, PointsNeedNotLieOnTheRaysOfTheirPixels) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> side(-100, 100);
  Map map(40, 30, Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < map.size(); ++i)
    map.data()[i] = {side(random), side(random), 101 + side(random)};
  Points queries;
  for (int i = 0; i < 500; ++i) queries.emplace_back(3 * side(random), side(random), side(random));
  EXPECT_EQ(by_tree(map, queries), by_brute_force(map, queries));
}

TEST(NearestPoints, QueriesMayLieAnywhere) {
  const Map map = surface(64, 48, 0);
  const Points queries{{0, 0, 0}, {0, 0, -500}, {9e5F, -9e5F, 3}, {-1e4F, 0, 1e-20F}, {0, 0, 1e9F}};
  EXPECT_EQ(by_tree(map, queries), by_brute_force(map, queries));
}

TEST(NearestPoints, QueriesThatAreNotFiniteHaveNoDistanceAndDisturbNoOther) {
  const Map map = surface(64, 48, 0);
  Points queries = points_of(surface(64, 48, 5));
  const std::vector<float> expected = by_tree(map, queries);
  for (std::size_t i = 0; i < queries.size(); i += 3) queries[i].y() = i % 2 == 0 ? nowhere : std::nanf("");
  const std::vector<float> found = by_tree(map, queries);
  for (std::size_t i = 0; i < queries.size(); ++i)
    if (i % 3 == 0)
      EXPECT_TRUE(std::isnan(found[i]));
    else
      EXPECT_EQ(found[i], expected[i]);
  EXPECT_TRUE(std::isnan(by_tree(map, {{nowhere, 0, 0}})[0]));
}

TEST(NearestPoints, PointsThatAreNotFiniteAreNotFound) {
  Map map(4, 4, Eigen::Vector3f(std::nanf(""), 0, 700));
  map(0, 0) = {0, 0, nowhere};
  map(1, 0) = {0, 0, -5};
  EXPECT_TRUE(NearestPoints(map, camera_of(4, 4)).empty());
  map(3, 3) = {0, 0, 700};
  EXPECT_EQ(by_tree(map, {{0, 0, 690}}), std::vector<float>{10});
}

TEST(NearestPoints, NoQueryGivesNoDistance) { EXPECT_TRUE(by_tree(surface(8, 8, 0), {}).empty()); }

}  // namespace
}  // namespace pliant
