#include "framework/deformation/skinning.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "framework/core/error.h"
#include "framework/geometry/point_set.h"
#include "tests/device/shapes.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Points random_points(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> across(-150, 150), deep(750, 850);
  Points points(count);
  for (auto& point : points) {
    point.x() = across(generator);
    point.y() = across(generator);
    point.z() = deep(generator);
  }
  return points;
}

/// Distances from a point to its influencing nodes, nearest first; they, unlike the nodes, are the same in
/// every exact search, whatever it makes of ties.
std::vector<float> distances(const Influences& influences, const Points& points, const Points& nodes) {
  const auto k = static_cast<std::size_t>(influences.per_point);
  std::vector<float> all;
  for (std::size_t entry = 0; entry < k * points.size(); ++entry)
    all.push_back(
        (points[entry / k] - nodes[static_cast<std::size_t>(influences.nodes.host()[entry])]).norm());
  return all;
}

void expect_weights_sum_to_one(const Influences& influences, std::size_t points) {
  const auto k = static_cast<std::ptrdiff_t>(influences.per_point);
  const auto& weights = influences.weights.host();
  ASSERT_EQ(weights.size(), points * static_cast<std::size_t>(k));
  for (auto first = weights.begin(); first != weights.end(); first += k) {
    EXPECT_NEAR(std::accumulate(first, first + k, 0.0), 1, 1e-5);
    EXPECT_GE(*std::min_element(first, first + k), 0);
    EXPECT_TRUE(std::is_sorted(first, first + k, std::greater<>())) << "nearer nodes weigh no less";
  }
}

class SkinningTest : public testing::TestWithParam<DeviceOptions> {
 protected:
  Influences on_device(const Points& points, const Points& nodes, int k) {
    return compute_influences(device_, flatten(points), nodes, k);
  }

  void expect_same_as_reference(const Points& points, const Points& nodes, int k) {
    SCOPED_TRACE(testing::Message() << nodes.size() << " nodes, k = " << k);
    const auto found = on_device(points, nodes, k);
    const auto expected = compute_influences_reference(flatten(points).host(), nodes, k);
    ASSERT_EQ(found.per_point, std::min(k, static_cast<int>(nodes.size())));
    ASSERT_EQ(found.per_point, expected.per_point);
    EXPECT_THAT(distances(found, points, nodes),
                testing::Pointwise(testing::FloatNear(1e-3F), distances(expected, points, nodes)));
    EXPECT_THAT(found.weights.host(), testing::Pointwise(testing::FloatNear(2e-5F), expected.weights.host()));
    expect_weights_sum_to_one(found, points.size());
  }

  // Small whole numbers: every squared distance is exact, so that ties are ties on both sides.
  void expect_ties_to_go_to_the_lower_node(int k) {
    Points nodes, points;
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y) {
        nodes.emplace_back(2 * x, 2 * y, 0);
        points.emplace_back(2 * x + 1, 2 * y + 1, 0);
      }
    const auto found = on_device(points, nodes, k);
    const auto expected = compute_influences_reference(flatten(points).host(), nodes, k);
    EXPECT_EQ(found.nodes.host(), expected.nodes.host()) << "k = " << k;
    EXPECT_THAT(found.weights.host(), testing::Pointwise(testing::FloatNear(1e-6F), expected.weights.host()));
  }

  Device device_{"any", GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Shapes, SkinningTest, testing::ValuesIn(test::device_shapes));

/// Many programs, one for each k: these are built in one shape alone.
class SkinningForEveryK : public SkinningTest {};

INSTANTIATE_TEST_SUITE_P(Shapes, SkinningForEveryK, testing::Values(test::device_shapes.front()));

TEST_P(SkinningForEveryK, TheDeviceAgreesWithTheReference) {
  const auto points = random_points(301, 1);
  for (int k = 1; k <= 8; ++k) expect_same_as_reference(points, random_points(200, 2), k);
  expect_same_as_reference(points, random_points(200, 2), max_influences);
}

TEST_P(SkinningTest, TheDeviceAgreesWithTheReference) {
  for (const int k : {1, 4}) expect_same_as_reference(random_points(301, 1), random_points(200, 2), k);
}

TEST_P(SkinningTest, EveryNumberOfNodesAroundTheVectorWidthIsPadded) {
  const auto points = random_points(40, 3);
  for (const std::size_t count : {5U, 15U, 16U, 17U, 31U, 32U, 33U})
    expect_same_as_reference(points, random_points(count, 4), 4);
}

TEST_P(SkinningForEveryK, NoMoreNodesThanAskedForMoveEveryPointTogether) {
  const auto points = random_points(50, 5);
  for (int k = 1; k <= max_influences; ++k)
    for (const int count : {1, 2, 3, k - 1, k, k + 1})
      if (count > 0) expect_same_as_reference(points, random_points(static_cast<std::size_t>(count), 6), k);
}

TEST_P(SkinningTest, OneNodeAloneWeighsOne) {
  const Points points{{0, 0, 0}, {1, 2, 3}, {5, 5, 5}};
  for (const auto& found : {on_device(points, {{5, 5, 5}}, 4),
                            compute_influences_reference(flatten(points).host(), {{5, 5, 5}}, 4)}) {
    EXPECT_EQ(found.per_point, 1);
    EXPECT_THAT(found.nodes.host(), testing::ElementsAre(0, 0, 0));
    EXPECT_THAT(found.weights.host(), testing::ElementsAre(1, 1, 1));
    EXPECT_TRUE(find_edges(found, 1).empty());
  }
}

// Two nodes for four: at the nearer one closeness 1 and (1 - 1/2)^2, half-way the same for both.
TEST_P(SkinningTest, WithoutANextNodeTwiceTheFarthestOneCounts) {
  const auto found = on_device({{0, 0, 0}, {5, 0, 0}}, {{0, 0, 0}, {10, 0, 0}}, 4);
  EXPECT_THAT(found.nodes.host(), testing::ElementsAre(0, 1, 0, 1));
  EXPECT_THAT(found.weights.host(), testing::Pointwise(testing::FloatNear(1e-6F), {0.8F, 0.2F, 0.5F, 0.5F}));
  EXPECT_THAT(find_edges(found, 2), testing::ElementsAre(Edge{0, 1}, Edge{1, 0}));
}

TEST_P(SkinningTest, WeightsNeedANodeAndAPossibleNumberOfThem) {
  const auto points = random_points(3, 5);
  EXPECT_THROW(on_device(points, random_points(30, 6), 0), DataError);
  EXPECT_THROW(on_device(points, random_points(30, 6), max_influences + 1), DataError);
  EXPECT_THROW(on_device(points, {}, 4), DataError);
  EXPECT_THROW(compute_influences_reference(flatten(points).host(), {}, 4), DataError);
}

TEST_P(SkinningTest, PicksTheInfluencesOfSomePoints) {
  const Influences all{2, Array<int>(std::vector<int>{0, 1, 2, 3, 4, 5}),
                       Array<float>(std::vector<float>{0.9F, 0.1F, 0.8F, 0.2F, 0.7F, 0.3F})};
  const Influences picked = pick_influences(device_, all, Array<int>(std::vector<int>{2, 0}));
  EXPECT_EQ(picked.per_point, 2);
  EXPECT_THAT(picked.nodes.host(), testing::ElementsAre(4, 5, 0, 1));
  EXPECT_THAT(picked.weights.host(), testing::ElementsAre(0.7F, 0.3F, 0.9F, 0.1F));
}

TEST_P(SkinningTest, TiesGoToTheLowerNodeOnBothSides) { expect_ties_to_go_to_the_lower_node(4); }

TEST_P(SkinningForEveryK, TiesGoToTheLowerNodeOnBothSides) {
  for (int k = 1; k <= 8; ++k) expect_ties_to_go_to_the_lower_node(k);
}

TEST_P(SkinningTest, EquallyFarNodesWeighTheSame) {
  const Points nodes{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  const auto found = on_device({{0, 0, 0}}, nodes, 3);
  EXPECT_THAT(found.weights.host(), testing::Each(testing::FloatEq(1.0F / 3)));
  const auto coincident = on_device({{5, 5, 5}}, Points(4, {5, 5, 5}), 2);
  EXPECT_THAT(coincident.weights.host(), testing::Each(testing::FloatEq(0.5F)));
}

// Distances 0, 3, 4 and (k + 1)-th 5: closeness 1, (2/5)^2, (1/5)^2.
TEST_P(SkinningTest, WeightsAreThoseOfTheEquation) {
  const auto found = on_device({{0, 0, 0}}, {{4, 0, 0}, {0, 5, 0}, {0, 0, 0}, {0, 0, 3}}, 3);
  EXPECT_THAT(found.nodes.host(), testing::ElementsAre(2, 3, 0));
  EXPECT_THAT(found.weights.host(), testing::ElementsAre(testing::FloatNear(1 / 1.2F, 1e-6F),
                                                         testing::FloatNear(0.16F / 1.2F, 1e-6F),
                                                         testing::FloatNear(0.04F / 1.2F, 1e-6F)));
}

TEST_P(SkinningForEveryK, FlannFindsTheSameNodes) {
  const auto points = random_points(500, 7), nodes = random_points(333, 8);
  auto node_values = flatten(nodes).host(), point_values = flatten(points).host();
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> index(
      flann::Matrix<float>(node_values.data(), nodes.size(), 3));
  index.buildIndex();
  for (int k = 1; k <= 8; ++k) {
    const auto neighbours = static_cast<std::size_t>(k);
    std::vector<int> expected(points.size() * neighbours);
    std::vector<float> squared(expected.size());
    flann::Matrix<int> expected_rows(expected.data(), points.size(), neighbours);
    flann::Matrix<float> squared_rows(squared.data(), points.size(), neighbours);
    flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
    index.knnSearch(flann::Matrix<float>(point_values.data(), points.size(), 3), expected_rows, squared_rows,
                    neighbours, exact);
    EXPECT_EQ(on_device(points, nodes, k).nodes.host(), expected) << "k = " << k;
  }
}

TEST_P(SkinningTest, NoPointsGiveNoInfluences) {
  const auto none = on_device({}, random_points(9, 1), 4);
  EXPECT_TRUE(none.nodes.host().empty());
  EXPECT_TRUE(none.weights.host().empty());
}

TEST_P(SkinningTest, TheSameBitsEveryTime) {
  const auto points = random_points(1000, 9), nodes = random_points(100, 10);
  EXPECT_EQ(on_device(points, nodes, 4).weights.host(), on_device(points, nodes, 4).weights.host());
}

Influences by_hand(int per_point, std::vector<int> nodes) {
  std::vector<float> weights(nodes.size(), 1.0F / static_cast<float>(per_point));
  return {per_point, Array<int>(std::move(nodes)), Array<float>(std::move(weights))};
}

TEST(FindEdges, NodesOfACommonPointAreNeighboursBothWays) {
  const auto edges = find_edges(by_hand(2, {3, 0, 0, 1, 0, 3}), 5);
  EXPECT_THAT(edges, testing::ElementsAre(Edge{0, 1}, Edge{0, 3}, Edge{1, 0}, Edge{3, 0}))
      << "sorted, once each, and node 4 stays alone";
}

TEST(FindEdges, OneNodePerPointGivesNoEdge) {
  EXPECT_TRUE(find_edges(by_hand(1, {0, 1, 2}), 3).empty());
  EXPECT_TRUE(find_edges(by_hand(2, {}), 3).empty());
}

TEST(FindEdges, AreThePairsOfAllPoints) {
  const auto points = random_points(200, 11), nodes = random_points(30, 12);
  const auto influences = compute_influences_reference(flatten(points).host(), nodes, 4);
  std::set<std::pair<int, int>> expected;
  const auto& found = influences.nodes.host();
  for (std::size_t a = 0; a < found.size(); ++a)
    for (std::size_t b = a / 4 * 4; b < a / 4 * 4 + 4; ++b)
      if (a != b) expected.emplace(found[a], found[b]);
  std::vector<Edge> sorted;
  for (const auto& [from, to] : expected) sorted.push_back({from, to});
  EXPECT_EQ(find_edges(influences, 30), sorted);
}

}  // namespace
}  // namespace pliant
