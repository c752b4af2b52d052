#include "framework/registration/matched_problem.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

/// The features as constraints whose targets stay.
std::shared_ptr<Constraints> make_feature_constraints(Device& device, const NonRigidMethod& method,
                                                      const PointMatches& features,
                                                      const EmbeddedGraph& graph) {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> data;
  for (std::size_t i = 0; i < features.size(); ++i) {
    points.push_back(features.from[i].cast<float>());
    const Eigen::Vector3f way = (features.to[i] - features.from[i]).cast<float>();
    data.insert(data.end(), {way.x(), way.y(), way.z(), 0, 0, 0});
  }
  auto constraints = std::make_shared<Constraints>();
  constraints->points = flatten(points);
  constraints->influences =
      compute_influences(device, constraints->points, graph.positions, method.nearest_nodes);
  constraints->data = Array<float>(std::move(data));
  constraints->confidence = Array<float>(features.confidence);
  return constraints;
}

std::vector<Term> make_terms(Device& device, const NonRigidMethod& method, const PointMatches& features,
                             const EmbeddedGraph& graph, const std::shared_ptr<Constraints>& surface) {
  std::shared_ptr<Constraints> held;
  if (uses_features(method)) held = make_feature_constraints(device, method, features, graph);
  std::vector<Term> terms;
  for (const Energy& energy : method.energies) {
    if (!applies(method, energy)) continue;
    std::shared_ptr<Constraints> constraints;
    if (energy.stencil == Stencil::per_constraint) constraints = energy.uses_features() ? held : surface;
    terms.push_back({energy, std::move(constraints)});
  }
  return terms;
}

}  // namespace

Constraints unmatched_at(Array<float> points) {
  Constraints constraints;
  constraints.data = Array<float>(2 * points.size());
  constraints.confidence = Array<float>(points.size() / 3);
  constraints.points = std::move(points);
  return constraints;
}

Array<int> first_indices(std::size_t count) {
  std::vector<int> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return Array<int>(std::move(indices));
}

bool applies(const NonRigidMethod& method, const Energy& energy) {
  return energy.weight > 0 && (!energy.uses_features() || uses_features(method));
}

MatchedConstraints make_constraints(Device& device, const NonRigidInput& input,
                                    const PointSelection& selection, bool follows_all) {
  const std::vector<int>& points = selection.points();
  if (points.empty())
    throw DataError(fmt::format("{}: no constraint falls on the source; choose a finer one", input.name));
  Array<int> indices(points);
  PointSet rest = pick_points(device, input.rest, indices);
  auto constraints = std::make_shared<Constraints>(unmatched_at(rest.points.clone()));
  return {points, follows_all ? std::move(indices) : first_indices(points.size()),
          Array<float>(selection.weights()), std::move(rest), std::move(constraints)};
}

std::unique_ptr<Problem> make_problem(Device& device, const NonRigidMethod& method,
                                      const PointMatches& features, const EmbeddedGraph& graph,
                                      const MatchedConstraints& matched) {
  matched.constraints->influences = pick_influences(device, graph.influences, Array<int>(matched.points));
  return std::make_unique<Problem>(DeformationGraph{graph.positions, graph.edges},
                                   make_terms(device, method, features, graph, matched.constraints),
                                   method.length_unit, *method.transform);
}

}  // namespace pliant
