#include "framework/registration/matched_problem.h"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

std::vector<Eigen::Vector3f> pick(const std::vector<Eigen::Vector3f>& points,
                                  const std::vector<int>& indices) {
  std::vector<Eigen::Vector3f> picked;
  picked.reserve(indices.size());
  for (const int index : indices) picked.push_back(points[static_cast<std::size_t>(index)]);
  return picked;
}

std::shared_ptr<Constraints> make_constraints(const std::vector<Eigen::Vector3f>& points,
                                              Influences influences) {
  auto constraints = std::make_shared<Constraints>();
  constraints->points = flatten(points);
  constraints->influences = std::move(influences);
  constraints->data = Array<float>(std::vector<float>(6 * points.size(), 0.0F));
  constraints->confidence = Array<float>(std::vector<float>(points.size(), 0.0F));
  return constraints;
}

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
  auto constraints = make_constraints(
      points, compute_influences(device, flatten(points), graph.positions, method.nearest_nodes));
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

Array<int> first_indices(std::size_t count) {
  std::vector<int> indices(count);
  std::iota(indices.begin(), indices.end(), 0);
  return Array<int>(std::move(indices));
}

}  // namespace

bool applies(const NonRigidMethod& method, const Energy& energy) {
  return energy.weight > 0 && (!energy.uses_features() || uses_features(method));
}

MatchedProblem make_matched_problem(Device& device, const NonRigidMethod& method, const NonRigidInput& input,
                                    const EmbeddedGraph& graph, const PointSelection& selection,
                                    bool follows_all) {
  const std::vector<int>& points = selection.points();
  if (points.empty())
    throw DataError(fmt::format("{}: no constraint falls on the source; choose a finer one", input.name));
  Array<int> selected(points);
  auto constraints = make_constraints(pick(input.source.points, points),
                                      pick_influences(device, graph.influences, selected));
  if (!follows_all) selected = first_indices(points.size());
  auto problem = std::make_unique<Problem>(DeformationGraph{graph.positions, graph.edges},
                                           make_terms(device, method, input.features, graph, constraints),
                                           method.length_unit, *method.transform);
  return {std::move(selected), Array<float>(selection.weights()), std::move(constraints), std::move(problem)};
}

}  // namespace pliant
