#include "framework/problem/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"

namespace pliant {
namespace {

void check_edges(const DeformationGraph& graph) {
  const auto count = static_cast<int>(graph.nodes.size());
  for (const auto& edge : graph.edges) {
    if (std::min(edge.from, edge.to) < 0 || std::max(edge.from, edge.to) >= count)
      throw DataError(
          fmt::format("edge ({}, {}) names a node that is not among the {}", edge.from, edge.to, count));
    if (edge.from == edge.to) throw DataError(fmt::format("an edge joins node {} with itself", edge.from));
  }
}

// Ceres aborts when an instance names the same unknowns twice.
void check_repetition(const Influences& influences) {
  const auto k = static_cast<std::ptrdiff_t>(influences.per_point);
  const auto& nodes = influences.nodes.host();
  for (auto begin = nodes.begin(); begin != nodes.end(); begin += k)
    for (auto node = begin; node != begin + k; ++node)
      if (std::find(begin, node, *node) != node)
        throw DataError(fmt::format("a constraint hangs on node {} twice", *node));
}

void check_constraints(const Constraints& constraints, int node_count) {
  const auto count = constraints.size();
  const auto entries = count * static_cast<std::size_t>(constraints.influences.per_point);
  if ((count > 0 && constraints.influences.per_point < 1) || constraints.points.size() != 3 * count ||
      constraints.influences.nodes.size() != entries || constraints.influences.weights.size() != entries ||
      constraints.data.size() != 6 * count || constraints.confidence.size() != count)
    throw DataError(fmt::format("the arrays of {} constraints do not fit together", count));
  for (const int node : constraints.influences.nodes.host())
    if (node < 0 || node >= node_count)
      throw DataError(fmt::format("a constraint hangs on node {} of {}", node, node_count));
  check_repetition(constraints.influences);
}

void check_weight(const Energy& energy) {
  if (!(energy.weight >= 0) || !std::isfinite(energy.weight))
    throw DataError(fmt::format("the weight of energy {} is {}", energy.equation.name, energy.weight));
}

void check_loss(const Energy& energy) {
  if (!(energy.loss.scale > 0) || !std::isfinite(energy.loss.scale))
    throw DataError(
        fmt::format("the scale of the loss of energy {} is {}", energy.equation.name, energy.loss.scale));
}

double squared_norm(const std::array<double, max_residuals>& r, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += r[static_cast<std::size_t>(i)] * r[static_cast<std::size_t>(i)];
  return sum;
}

void gather_constraint(const Problem& problem, const Constraints& constraints, std::size_t index,
                       const double* unknowns, double* u, double* data) {
  const auto k = static_cast<std::size_t>(constraints.influences.per_point);
  const float* point = constraints.points.host().data() + 3 * index;
  std::fill(u, u + 3, 0.0);
  for (std::size_t slot = k * index; slot < k * (index + 1); ++slot) {
    const auto node = static_cast<std::size_t>(constraints.influences.nodes.host()[slot]);
    const double weight = constraints.influences.weights.host()[slot];
    const double* form = unknowns + affine_size * node;
    for (int axis = 0; axis < 3; ++axis) {
      double moved = form[9 + axis];
      for (int column = 0; column < 3; ++column)
        moved += form[3 * column + axis] * (static_cast<double>(point[column]) -
                                            static_cast<double>(problem.graph().nodes[node][column]));
      u[axis] += weight * moved;
    }
  }
  const auto begin = constraints.data.host().begin() + static_cast<std::ptrdiff_t>(6 * index);
  std::copy(begin, begin + 6, data);
}

}  // namespace

Problem::Problem(DeformationGraph graph, std::vector<Term> terms, double length_unit, NodeTransform transform)
    : graph_(std::move(graph)),
      terms_(std::move(terms)),
      length_unit_(length_unit),
      transform_(std::move(transform)) {
  if (graph_.nodes.empty()) throw DataError("a problem needs at least one node");
  if (!(length_unit_ > 0) || !std::isfinite(length_unit_))
    throw DataError(fmt::format("a unit of length of {} mm", length_unit_));
  check_edges(graph_);
  for (const auto& term : terms_) {
    check_weight(term.energy);
    check_loss(term.energy);
    if ((term.energy.stencil == Stencil::per_constraint) != (term.constraints != nullptr))
      throw DataError(fmt::format("energy {} {} constraints", term.energy.equation.name,
                                  term.constraints ? "takes no" : "needs"));
    if (term.constraints) check_constraints(*term.constraints, node_count());
  }
  std::vector<float> points;
  for (const auto& node : graph_.nodes) points.insert(points.end(), node.data(), node.data() + 3);
  node_points_ = Array<float>(std::move(points));
  unknowns_ = Array<float>(std::vector<float>(affine_size * graph_.nodes.size(), 0.0F));
}

void Problem::reset_to_identity() {
  auto& values = unknowns_.write_host();
  std::fill(values.begin(), values.end(), 0.0F);
}

void Problem::set_weight(std::size_t term, double weight) {
  Energy changed = terms_.at(term).energy;
  changed.weight = weight;
  check_weight(changed);
  terms_[term].energy.weight = weight;
}

void Problem::set_loss_scale(std::size_t term, double scale) {
  Energy changed = terms_.at(term).energy;
  changed.loss.scale = scale;
  check_loss(changed);
  terms_[term].energy.loss.scale = scale;
}

double Problem::effective_weight(const Term& term) const {
  const double scale = term.energy.in_length ? 1.0 / (length_unit_ * length_unit_) : 1.0;
  return term.energy.weight * scale;
}

double Problem::energy(const std::vector<double>& unknowns) const {
  std::array<double, max_stencil_inputs> u{};
  std::array<double, max_stencil_data> data{};
  std::array<double, max_residuals> r{};
  double total = 0;
  for (const auto& term : terms_) {
    double sum = 0;
    for (std::size_t i = 0; i < instance_count(*this, term); ++i) {
      gather_instance(*this, term, i, unknowns.data(), u.data(), data.data());
      term.energy.equation.residual(u.data(), data.data(), r.data());
      const double confidence = term.constraints ? term.constraints->confidence.host()[i] : 1.0;
      if (confidence > 0) sum += confidence * term.energy.loss.value(squared_norm(r, term.energy.residuals));
    }
    total += effective_weight(term) * sum;
  }
  return total;
}

double Problem::energy() const {
  const auto& values = unknowns_.host();
  return energy(std::vector<double>(values.begin(), values.end()));
}

std::size_t instance_count(const Problem& problem, const Term& term) {
  switch (term.energy.stencil) {
    case Stencil::per_node:
      return problem.graph().nodes.size();
    case Stencil::per_edge:
      return problem.graph().edges.size();
    case Stencil::per_constraint:
      return term.constraints->size();
  }
  return 0;
}

std::vector<int> coupled_nodes(const Problem& problem, const Term& term, std::size_t instance) {
  switch (term.energy.stencil) {
    case Stencil::per_node:
      return {static_cast<int>(instance)};
    case Stencil::per_edge: {
      const auto& edge = problem.graph().edges[instance];
      return {edge.from, edge.to};
    }
    case Stencil::per_constraint: {
      const auto& influences = term.constraints->influences;
      const auto k = static_cast<std::ptrdiff_t>(influences.per_point);
      const auto begin = influences.nodes.host().begin() + k * static_cast<std::ptrdiff_t>(instance);
      return {begin, begin + k};
    }
  }
  return {};
}

void gather_instance(const Problem& problem, const Term& term, std::size_t index, const double* unknowns,
                     double* u, double* data) {
  const auto form_of = [&](int node) { return unknowns + affine_size * node; };
  switch (term.energy.stencil) {
    case Stencil::per_node:
      std::copy_n(form_of(static_cast<int>(index)), affine_size, u);
      break;
    case Stencil::per_edge: {
      const auto& edge = problem.graph().edges[index];
      std::copy_n(form_of(edge.from), affine_size, u);
      std::copy_n(form_of(edge.to), affine_size, u + affine_size);
      const auto& nodes = problem.graph().nodes;
      Eigen::Map<Eigen::Vector3d>{data} = nodes[static_cast<std::size_t>(edge.to)].cast<double>() -
                                          nodes[static_cast<std::size_t>(edge.from)].cast<double>();
      break;
    }
    case Stencil::per_constraint:
      gather_constraint(problem, *term.constraints, index, unknowns, u, data);
      break;
  }
}

}  // namespace pliant
