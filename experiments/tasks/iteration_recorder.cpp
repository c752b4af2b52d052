#include "experiments/tasks/iteration_recorder.h"

#include "framework/deformation/warp.h"

namespace pliant {
namespace {

std::vector<Eigen::Vector3f> moved(Device& device, const PointSet& rest, const Influences& influences,
                                   const IterationView& view) {
  PointSet points{Array<float>(rest.points.size()), Array<float>(rest.normals.size())};
  warp(device, rest, influences, view.graph.node_points, view.unknowns, points);
  return unflatten(points.points);
}

}  // namespace

Observer IterationRecorder::observer() {
  return [this](const IterationView& view) {
    if (rest_.empty()) rest_ = unflatten(view.rest.points);
    if (graphs_.empty()) keep_graph(view.graph);
    // One that fails comes under the number of the one before.
    const bool is_new = iterations_.empty() || iterations_.back().number != view.number;
    if (is_new && numbers_.count(view.number) > 0) record(view);
  };
}

void IterationRecorder::keep_graph(const EmbeddedGraph& graph) {
  if (!graphs_.empty() && graphs_.back().nodes == graph.nodes) return;
  graphs_.push_back({graph.nodes, graph.edges, graph.cells});
}

void IterationRecorder::record(const IterationView& view) {
  keep_graph(view.graph);
  iterations_.push_back({view.number, moved(device_, view.rest, view.graph.influences, view),
                         graphs_.size() - 1, matched(view)});
}

std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>> IterationRecorder::matched(
    const IterationView& view) const {
  const Constraints& constraints = view.constraints;
  const PointSet rest{constraints.points.clone(),
                      Array<float>(std::vector<float>(constraints.points.size()))};
  const std::vector<Eigen::Vector3f> from = moved(device_, rest, constraints.influences, view);
  const std::vector<Eigen::Vector3f> points = unflatten(constraints.points);
  const auto& data = constraints.data.host();
  std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>> pairs;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (constraints.confidence.host()[i] > 0)
      pairs.emplace_back(from[i], points[i] + Eigen::Vector3f(data[6 * i], data[6 * i + 1], data[6 * i + 2]));
  return pairs;
}

}  // namespace pliant
