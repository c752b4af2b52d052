#include "framework/registration/registration.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "framework/core/error.h"
#include "framework/registration/residual.h"

namespace pliant {
namespace {

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Runs `work` and adds its time on the host to a stage.
template <class Work>
auto timed(StageTimes& times, const std::string& stage, Work work) {
  const Stopwatch watch;
  auto result = work();
  times[stage] += watch.milliseconds();
  return result;
}

Array<float> flatten(const std::vector<Eigen::Vector3f>& vectors) {
  std::vector<float> values;
  values.reserve(3 * vectors.size());
  for (const auto& vector : vectors) values.insert(values.end(), vector.data(), vector.data() + 3);
  return Array<float>(std::move(values));
}

std::vector<Eigen::Vector3f> unflatten(const Array<float>& values) {
  std::vector<Eigen::Vector3f> vectors;
  vectors.reserve(values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3)
    vectors.emplace_back(values.host()[i], values.host()[i + 1], values.host()[i + 2]);
  return vectors;
}

template <class T>
std::vector<T> pick(const std::vector<T>& values, const std::vector<int>& indices) {
  std::vector<T> picked;
  picked.reserve(indices.size());
  for (const int index : indices) picked.push_back(values[static_cast<std::size_t>(index)]);
  return picked;
}

Surface move_rigidly(const Surface& surface, const Eigen::Isometry3d& motion) {
  Surface moved = surface;
  const Eigen::Isometry3f single = motion.cast<float>();
  for (auto& point : moved.points) point = single * point;
  for (auto& normal : moved.normals) normal = single.linear() * normal;
  return moved;
}

/// The right-hand column of Figure 4.1 before its loop begins: aligned source, graph, weights, constraints.
struct Setup {
  Surface source;   ///< as given
  Surface aligned;  ///< after the initial alignment
  AlignmentResult alignment;
  Target target;
  std::vector<int> nodes;  ///< indices of points
  Array<float> node_points;
  Influences influences;  ///< of every point of the source
  PointSet rest;          ///< `aligned` on the device
  Array<int> selected;    ///< the points that are constrained
  std::shared_ptr<Constraints> constraints;
  std::unique_ptr<Problem> problem;
};

void check_selection(const FramePair& pair, const char* what, const std::vector<int>& selected) {
  if (selected.empty())
    throw DataError(fmt::format("{}: no {} falls on the source; choose a finer one", pair.name, what));
}

std::shared_ptr<Constraints> make_constraints(Device& device, const Method& method,
                                              const std::vector<Eigen::Vector3f>& points,
                                              const std::vector<Eigen::Vector3f>& node_positions) {
  auto constraints = std::make_shared<Constraints>();
  constraints->points = flatten(points);
  constraints->influences =
      compute_influences(device, constraints->points, node_positions, method.nearest_nodes);
  constraints->data = Array<float>(std::vector<float>(6 * points.size(), 0.0F));
  constraints->confidence = Array<float>(std::vector<float>(points.size(), 0.0F));
  return constraints;
}

std::vector<Term> make_terms(const Method& method, const std::shared_ptr<Constraints>& constraints) {
  std::vector<Term> terms;
  for (const Energy& energy : method.energies)
    terms.push_back({energy, energy.stencil == Stencil::per_constraint ? constraints : nullptr});
  return terms;
}

Setup set_up(const FramePair& pair, const Method& method, Device& device, std::uint64_t seed,
             StageTimes& times) {
  Surface source = timed(times, "surface", [&] {
    return make_surface(make_surface_map(pair.source, pair.camera), pair.source.color);
  });
  if (source.size() == 0) throw DataError(pair.name + ": the source has no point");
  Target target = timed(times, "surface",
                        [&] { return Target(pair.camera, make_surface_map(pair.target, pair.camera)); });
  const AlignmentResult alignment =
      timed(times, "alignment", [&] { return method.alignment->align(pair, seed); });
  Surface aligned = move_rigidly(source, alignment.motion);

  std::vector<int> nodes = timed(times, "ans", [&] { return method.graph->select_nodes(aligned); });
  check_selection(pair, "node of the graph", nodes);
  const auto positions = pick(aligned.points, nodes);
  PointSet rest{flatten(aligned.points), flatten(aligned.normals)};
  Influences influences = compute_influences(device, rest.points, positions, method.nearest_nodes);
  auto edges =
      timed(times, "edges", [&] { return find_edges(influences, static_cast<int>(positions.size())); });

  std::vector<int> selected = timed(times, "acs", [&] { return method.sampler->select(aligned); });
  check_selection(pair, "constraint", selected);
  auto constraints = make_constraints(device, method, pick(aligned.points, selected), positions);
  auto problem = std::make_unique<Problem>(DeformationGraph{positions, std::move(edges)},
                                           make_terms(method, constraints), method.length_unit);
  return {std::move(source),      std::move(aligned), alignment,
          std::move(target),      std::move(nodes),   flatten(positions),
          std::move(influences),  std::move(rest),    Array<int>(std::move(selected)),
          std::move(constraints), std::move(problem)};
}

/// The loop of Figure 4.1: match, minimise, update the source, measure the residual.
class Loop {
 public:
  Loop(Setup& setup, const Method& method, Device& device)
      : setup_(setup),
        method_(method),
        device_(device),
        moved_{Array<float>(setup.rest.points.host()), Array<float>(setup.rest.normals.host())},
        meter_(device, setup.target, setup.aligned.size()) {}

  void run(const FramePair& pair, const ProgressSink& progress) {
    const auto solver = method_.solver->bind(*setup_.problem, device_);
    double residual = measure(pair);
    while (termination_.empty()) {
      match();
      solver->solve();
      update_source();
      const double previous = std::exchange(residual, measure(pair));
      ++iterations_;
      termination_ = reason_to_stop(previous, residual);
      report(pair, residual, progress);
    }
    summaries_ = solver->summaries();
  }

  int iterations() const { return iterations_; }
  const std::string& termination() const { return termination_; }
  const PointSet& moved() const { return moved_; }
  const std::vector<SolverSummary>& summaries() const { return summaries_; }

 private:
  void match() {
    method_.correspondence->match(device_, moved_, setup_.selected, setup_.target, *setup_.constraints);
  }

  void update_source() {
    warp(device_, setup_.rest, setup_.influences, setup_.node_points, setup_.problem->unknowns(), moved_);
  }

  double measure(const FramePair& pair) {
    const Residual residual = meter_.measure(moved_.points);
    if (!std::isfinite(residual.mean))
      throw NumericalError(
          fmt::format("{}: the residual is not finite after {} outer iterations", pair.name, iterations_));
    if (residual.landed == 0)
      throw DataError(fmt::format("{}: no point of the source projects onto a point of the target{}",
                                  pair.name, iterations_ == 0 ? "; an initial alignment may help" : ""));
    return residual.mean;
  }

  std::string reason_to_stop(double previous, double residual) const {
    if (residual < method_.stopping.residual) return "residual";
    if (iterations_ >= method_.stopping.max_iterations) return "max_iterations";
    if (std::abs(previous - residual) < method_.stopping.min_progress * previous) return "no_progress";
    return "";
  }

  void report(const FramePair& pair, double residual, const ProgressSink& progress) const {
    if (!progress) return;
    const double done =
        termination_.empty() ? static_cast<double>(iterations_) / method_.stopping.max_iterations : 1.0;
    progress({pair.name, done, fmt::format("iteration {}: residual {:.3f} mm", iterations_, residual)});
  }

  Setup& setup_;
  const Method& method_;
  Device& device_;
  PointSet moved_;
  ResidualMeter meter_;
  int iterations_ = 0;
  std::string termination_;
  std::vector<SolverSummary> summaries_;
};

void record_solves(const std::vector<SolverSummary>& summaries, RegistrationResult& result) {
  result.energy.initial = summaries.front().initial_energy;
  result.energy.final = summaries.back().final_energy;
  for (const auto& summary : summaries) {
    result.energy.per_iteration.push_back(summary.final_energy);
    result.counts.solver_iterations += summary.iterations;
    for (const auto& [stage, time] : summary.time_ms) result.time_ms[stage] += time;
  }
  result.solver = {summaries.back().solver, summaries.back().linear_solver, summaries.back().termination};
}

RegistrationResult to_result(Setup&& setup, const Loop& loop) {
  RegistrationResult result;
  result.points = unflatten(loop.moved().points);
  result.normals = unflatten(loop.moved().normals);
  result.node_positions = pick(setup.aligned.points, setup.nodes);
  result.counts.source_points = static_cast<int>(setup.source.size());
  result.counts.nodes = setup.problem->node_count();
  result.counts.edges = static_cast<int>(setup.problem->graph().edges.size());
  result.counts.constraints = static_cast<int>(setup.selected.size());
  result.counts.unknowns = setup.problem->unknown_count();
  result.counts.outer_iterations = loop.iterations();
  result.termination = loop.termination();
  result.source = std::move(setup.source);
  result.aligned_points = std::move(setup.aligned.points);
  result.alignment = setup.alignment;
  return result;
}

}  // namespace

RegistrationResult register_pair(const FramePair& pair, const Method& method, Device& device,
                                 std::uint64_t seed, const ProgressSink& progress) {
  const Stopwatch watch;
  StageTimes times;
  device.measure_stages(true);
  Setup setup = set_up(pair, method, device, seed, times);
  Loop loop(setup, method, device);
  loop.run(pair, progress);
  RegistrationResult result = to_result(std::move(setup), loop);
  result.time_ms = std::move(times);
  for (const auto& [stage, time] : device.take_stage_times()) result.time_ms[stage] += time;
  device.measure_stages(false);
  record_solves(loop.summaries(), result);
  result.total_ms = watch.milliseconds();
  return result;
}

std::unique_ptr<Problem> freeze_problem(const FramePair& pair, const Method& method, Device& device,
                                        std::uint64_t seed) {
  StageTimes times;
  Setup setup = set_up(pair, method, device, seed, times);
  method.correspondence->match(device, setup.rest, setup.selected, setup.target, *setup.constraints);
  return std::move(setup.problem);
}

}  // namespace pliant
