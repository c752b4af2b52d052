#include <gtest/gtest.h>

#include <functional>

#include "framework/deformation/warp.h"
#include "framework/tracking/model_registration.h"

namespace pliant {
namespace {

const Eigen::Isometry3d kMotion =
    Eigen::Translation3d(12, -7, 20) * Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, -2, 0.5).normalized());

/// Nodes on the front of a head, as large as one, before a camera.
EmbeddedGraph head_nodes() {
  EmbeddedGraph graph;
  for (int row = -5; row <= 5; ++row)
    for (int column = -4; column <= 4; ++column) {
      const auto x = static_cast<float>(18 * column), y = static_cast<float>(18 * row);
      graph.positions.emplace_back(x, y, 700 + (x * x + 0.5F * y * y) / 120);
    }
  graph.node_points = flatten(graph.positions);
  return graph;
}

/// Forms of nodes that all go by a motion, and after it by what `deformed` says of each.
Array<float> forms(const EmbeddedGraph& graph, const Eigen::Isometry3d& motion,
                   const std::function<Eigen::Vector3d(std::size_t)>& deformed) {
  std::vector<float> values;
  for (std::size_t j = 0; j < graph.positions.size(); ++j) {
    const Eigen::Vector3d node = graph.positions[j].cast<double>();
    Eigen::Matrix<float, 3, 4> form;
    form << (motion.linear() - Eigen::Matrix3d::Identity()).cast<float>(),
        (motion * node + deformed(j) - node).cast<float>();
    values.insert(values.end(), form.data(), form.data() + form.size());
  }
  return Array<float>(std::move(values));
}

/// Greatest distance between where two motions put those nodes of which `counts` holds.
double difference(const EmbeddedGraph& graph, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b,
                  const std::function<bool(std::size_t)>& counts) {
  double greatest = 0;
  for (std::size_t j = 0; j < graph.positions.size(); ++j) {
    const Eigen::Vector3d node = graph.positions[j].cast<double>();
    if (counts(j)) greatest = std::max(greatest, (a * node - b * node).norm());
  }
  return greatest;
}

bool any(std::size_t) { return true; }
Eigen::Vector3d nowhere(std::size_t) { return Eigen::Vector3d::Zero(); }

TEST(CommonMotion, IsTheMotionOfAllNodes) {
  const EmbeddedGraph graph = head_nodes();
  for (const Eigen::Isometry3d& motion : {Eigen::Isometry3d(Eigen::Isometry3d::Identity()), kMotion})
    EXPECT_LT(difference(graph, common_motion(graph, forms(graph, motion, nowhere)), motion, any), 1e-3);
}

TEST(CommonMotion, IsThatOfTheRestWhereThreeInTenNodesDeform) {
  const EmbeddedGraph graph = head_nodes();
  const auto scattered = [](std::size_t j) { return j % 10 < 3; };
  const auto below = [&](std::size_t j) { return j >= graph.positions.size() * 7 / 10; };
  for (const auto& deforms : std::vector<std::function<bool(std::size_t)>>{scattered, below}) {
    const auto deformed = [&](std::size_t j) {
      return deforms(j) ? Eigen::Vector3d(0, 0, -10) : Eigen::Vector3d(0, 0, 0);
    };
    const Eigen::Isometry3d found = common_motion(graph, forms(graph, kMotion, deformed));
    EXPECT_LT(difference(graph, found, kMotion, [&](std::size_t j) { return !deforms(j); }), 0.1);
  }
}

TEST(CommonMotion, IsRigidWhateverTheNodesDo) {
  EmbeddedGraph flat = head_nodes();
  for (Eigen::Vector3f& node : flat.positions) node.z() = 700;
  // Mirrored: the best linear map is no rotation.
  const auto mirrored = [&](std::size_t j) { return Eigen::Vector3d(-2 * flat.positions[j].x(), 0, 0); };
  const Eigen::Isometry3d found = common_motion(flat, forms(flat, Eigen::Isometry3d::Identity(), mirrored));
  EXPECT_NEAR(found.linear().determinant(), 1, 1e-9);
  EXPECT_LT((found.linear() * found.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST(CommonMotion, OfOneNodeIsWhereItGoes) {
  EmbeddedGraph graph;
  graph.positions = {{10, 20, 700}};
  const Eigen::Isometry3d found = common_motion(graph, forms(graph, kMotion, nowhere));
  EXPECT_TRUE(found.matrix().allFinite());
  EXPECT_LT(difference(graph, found, kMotion, any), 1e-3);
}

}  // namespace
}  // namespace pliant
