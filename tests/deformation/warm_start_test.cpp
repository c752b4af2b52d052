#include "framework/deformation/warm_start.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <random>

#include "framework/deformation/warp.h"
#include "framework/geometry/point_set.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3f>;
using Affine = Eigen::Matrix<float, 3, 4>;

Points pick(const Points& points, const std::vector<int>& indices) {
  Points picked;
  for (const int index : indices) picked.push_back(points[static_cast<std::size_t>(index)]);
  return picked;
}

/// A curved surface of 20 x 15 points that a graph of every 25th of them has deformed at random.
class WarmStartTest : public testing::Test {
 protected:
  WarmStartTest() {
    for (int v = 0; v < 15; ++v)
      for (int u = 0; u < 20; ++u)
        points_.emplace_back(8.0F * static_cast<float>(u), 8.0F * static_cast<float>(v),
                             800.0F + 0.1F * static_cast<float>(u * u));
    for (int point = 3; point < static_cast<int>(points_.size()); point += 25) nodes_.push_back(point);
    graph_.nodes = nodes_;
    graph_.positions = pick(points_, nodes_);
    graph_.influences = compute_influences_reference(flatten(points_).host(), graph_.positions, 4);
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    std::vector<float> forms(affine_size * nodes_.size());
    for (std::size_t i = 0; i < forms.size(); ++i)
      forms[i] = normal(generator) * (i % affine_size < 9 ? 0.05F : 5.0F);
    affine_ = Array<float>(std::move(forms));
  }

  Array<float> carried(const std::vector<int>& nodes) {
    EmbeddedGraph next;
    next.nodes = nodes;
    next.positions = pick(points_, nodes);
    return carry_over(device_, {graph_, affine_}, next);
  }

  /// The form of one node, column by column: R - I, t.
  static Affine form(const Array<float>& affine, std::size_t node) {
    return Eigen::Map<const Affine>(affine.host().data() + affine_size * node);
  }

  /// Where [Eq. 4.1] moves a place near a point, with that point's influences.
  Eigen::Vector3f moved(int point, const Eigen::Vector3f& place) const {
    const PointSet rest{flatten(Points{place}), Array<float>(std::vector<float>(3, 0.0F))};
    const auto first = 4 * static_cast<std::ptrdiff_t>(point);
    const auto& ids = graph_.influences.nodes.host();
    const auto& weights = graph_.influences.weights.host();
    const Influences own{
        4, Array<int>(std::vector<int>(ids.begin() + first, ids.begin() + first + 4)),
        Array<float>(std::vector<float>(weights.begin() + first, weights.begin() + first + 4))};
    const PointSet result = warp_reference(rest, own, flatten(pick(points_, nodes_)), affine_);
    return Eigen::Map<const Eigen::Vector3f>(result.points.host().data());
  }

  Device device_;
  Points points_;
  std::vector<int> nodes_;
  EmbeddedGraph graph_;
  Array<float> affine_;
};

TEST_F(WarmStartTest, KeptNodesKeepTheirTransforms) {
  EXPECT_EQ(carried(nodes_).host(), affine_.host());
  const Array<float> fewer = carried({nodes_[2], nodes_[7]});
  EXPECT_EQ(form(fewer, 0), form(affine_, 2));
  EXPECT_EQ(form(fewer, 1), form(affine_, 7));
}

TEST_F(WarmStartTest, ANewNodeMovesAsTheSurfaceMovedThere) {
  const std::vector<int> nodes = {0, 41, nodes_[3], 150, 299};
  const Array<float> affine = carried(nodes);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    if (nodes[j] == nodes_[3]) continue;
    const Eigen::Vector3f& rest = points_[static_cast<std::size_t>(nodes[j])];
    const Affine own = form(affine, j);
    EXPECT_LT((rest + own.col(3) - moved(nodes[j], rest)).norm(), 1e-3) << "node at point " << nodes[j];
    for (const Eigen::Vector3f& arm : {Eigen::Vector3f(9, 0, 0), Eigen::Vector3f(0, -7, 2)})
      EXPECT_LT((rest + arm + own.leftCols<3>() * arm + own.col(3) - moved(nodes[j], rest + arm)).norm(),
                1e-3)
          << "beside the node at point " << nodes[j];
  }
}

TEST_F(WarmStartTest, ARigidMotionSurvivesAnyChangeOfTheGraph) {
  const Eigen::Isometry3f motion =
      Eigen::Translation3f(4, -6, 11) * Eigen::AngleAxisf(0.3F, Eigen::Vector3f(1, 2, -1).normalized());
  const auto rigid = [&](int point) {
    const Eigen::Vector3f& node = points_[static_cast<std::size_t>(point)];
    Affine form;
    form << motion.linear() - Eigen::Matrix3f::Identity(), motion * node - node;
    return form;
  };
  auto& forms = affine_.write_host();
  for (std::size_t j = 0; j < nodes_.size(); ++j)
    Eigen::Map<Affine>(forms.data() + affine_size * j) = rigid(nodes_[j]);
  const std::vector<int> nodes = {1, 60, 128, 290};
  const Array<float> affine = carried(nodes);
  for (std::size_t j = 0; j < nodes.size(); ++j) EXPECT_LT((form(affine, j) - rigid(nodes[j])).norm(), 1e-3);
}

}  // namespace
}  // namespace pliant
