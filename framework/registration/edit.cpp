#include "framework/registration/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/core/error.h"
#include "framework/core/stopwatch.h"
#include "framework/deformation/embedded_graph.h"
#include "framework/deformation/warp.h"

namespace pliant {
namespace {

std::vector<Grip> take_hold(const NamedHandles& handles, const Surface& surface) {
  std::vector<Grip> grips;
  for (const auto& [name, handle] : handles) grips.push_back(take_hold(handle, surface));
  return grips;
}

/// The points that are held, asked to go where the handles want them; of the surface there, too, its normals.
std::shared_ptr<Constraints> make_constraints(Device& device, const Surface& surface,
                                              const std::vector<Grip>& grips, const Influences& influences) {
  std::vector<int> held;
  std::vector<Eigen::Vector3f> points;
  std::vector<float> data;
  for (const Grip& grip : grips) {
    for (const int index : grip.points) {
      const Eigen::Vector3f point = surface.points[static_cast<std::size_t>(index)];
      const Eigen::Vector3f pull = grip.motion * point - point;
      const Eigen::Vector3f normal = grip.motion.linear() * surface.normals[static_cast<std::size_t>(index)];
      held.push_back(index);
      points.push_back(point);
      data.insert(data.end(), {pull.x(), pull.y(), pull.z(), normal.x(), normal.y(), normal.z()});
    }
  }
  auto constraints = std::make_shared<Constraints>();
  constraints->points = flatten(points);
  constraints->influences = pick_influences(device, influences, Array<int>(std::move(held)));
  constraints->data = Array<float>(std::move(data));
  constraints->confidence = Array<float>(std::vector<float>(points.size(), 1.0F));
  return constraints;
}

/// One bending of a surface.
class Edit {
 public:
  Edit(const FramePair& pair, const NamedHandles& handles, const NonRigidMethod& method, Device& device)
      : name_(pair.name),
        handles_(handles),
        method_(method),
        device_(device),
        source_(source_surface(pair)),
        rest_{flatten(source_.points), flatten(source_.normals)},
        grips_(take_hold(handles, source_)),
        nodes_(timed(times_, "ans", [&] { return select_nodes(pair.camera); })),
        graph_(embed_graph(device, *nodes_, rest_, method.nearest_nodes, pair.name)) {
    connect(graph_, times_);
    make_problem();
  }

  std::unique_ptr<Problem> take_problem() { return std::move(problem_); }

  EditResult solve() {
    const auto solver = method_.solver->bind(*problem_, device_);
    solver->solve();
    const SolverSummary summary = solver->summaries().front();
    if (summary.termination == "failed") throw NumericalError(name_ + ": the solver found no finite step");
    PointSet moved{Array<float>(rest_.points.size()), Array<float>(rest_.normals.size())};
    warp(device_, rest_, graph_.influences, problem_->node_points(), problem_->unknowns(), moved);
    EditResult result;
    result.points = unflatten(moved.points);
    result.normals = unflatten(moved.normals);
    check_finite(result.points);
    record(summary, result);
    for (std::size_t i = 0; i < grips_.size(); ++i) result.handles.push_back(fit(i, result.points));
    result.source = std::move(source_);
    return result;
  }

 private:
  std::unique_ptr<NodeSelection> select_nodes(const Camera& camera) {
    return method_.graph->select_nodes(device_, {index_pixels(source_), rest_, camera});
  }

  void make_problem() {
    const auto held = make_constraints(device_, source_, grips_, graph_.influences);
    held_ = static_cast<int>(held->size());
    std::vector<Term> terms;
    for (const Energy& energy : method_.energies)
      terms.push_back({energy, energy.stencil == Stencil::per_constraint ? held : nullptr});
    problem_ = std::make_unique<Problem>(DeformationGraph{graph_.positions, graph_.edges}, std::move(terms),
                                         method_.length_unit, *method_.transform);
  }

  void check_finite(const std::vector<Eigen::Vector3f>& points) const {
    if (std::all_of(points.begin(), points.end(), [](const auto& point) { return point.allFinite(); }))
      return;
    throw NumericalError(name_ + ": the bent surface is not finite");
  }

  EditResult::HandleFit fit(std::size_t handle, const std::vector<Eigen::Vector3f>& moved) const {
    const Grip& grip = grips_[handle];
    EditResult::HandleFit fit{handles_[handle].first, static_cast<int>(grip.points.size())};
    for (const int index : grip.points) {
      const auto i = static_cast<std::size_t>(index);
      const Eigen::Vector3f wanted = grip.motion * source_.points[i];
      const double distance = (moved[i] - wanted).norm();
      fit.initial_mean += (source_.points[i] - wanted).norm();
      fit.mean += distance;
      fit.max = std::max(fit.max, distance);
    }
    fit.initial_mean /= fit.points;
    fit.mean /= fit.points;
    return fit;
  }

  void record(const SolverSummary& summary, EditResult& result) {
    result.node_positions = graph_.positions;
    result.graph_cells = graph_.cells;
    result.counts.source_points = static_cast<int>(source_.size());
    result.counts.nodes = problem_->node_count();
    result.counts.edges = static_cast<int>(problem_->graph().edges.size());
    result.counts.constraints = held_;
    result.counts.unknowns = problem_->unknown_count();
    result.counts.solver_iterations = summary.iterations;
    result.energy = {summary.initial_energy, summary.final_energy, summary.energies};
    result.solver = {summary.solver, summary.linear_solver, summary.termination};
    result.warnings = warnings_of(method_, result.counts);
    result.time_ms = times_;
    for (const auto& [stage, time] : summary.time_ms) result.time_ms[stage] += time;
    for (const auto& [stage, time] : device_.take_stage_times())
      if (stage != "ans") result.time_ms[stage] += time;  // the host's time of it holds the device's
  }

  StageTimes times_;
  const std::string& name_;
  const NamedHandles& handles_;
  const NonRigidMethod& method_;
  Device& device_;
  Surface source_;
  PointSet rest_;
  std::vector<Grip> grips_;
  std::unique_ptr<NodeSelection> nodes_;
  EmbeddedGraph graph_;
  int held_ = 0;
  std::unique_ptr<Problem> problem_;
};

}  // namespace

EditResult::HandleFit EditResult::all_handles() const {
  HandleFit all{"all"};
  for (const auto& handle : handles) {
    all.points += handle.points;
    all.initial_mean += handle.points * handle.initial_mean;
    all.mean += handle.points * handle.mean;
    all.max = std::max(all.max, handle.max);
  }
  if (all.points == 0) return all;
  all.initial_mean /= all.points;
  all.mean /= all.points;
  return all;
}

Surface source_surface(const FramePair& pair) {
  check_source(pair);
  Surface surface = make_surface(make_surface_image(pair.source, pair.camera), pair.source.color);
  if (surface.points.empty()) throw DataError(pair.name + ": the source has no point");
  return surface;
}

EditResult edit_surface(const FramePair& pair, const NamedHandles& handles, const NonRigidMethod& method,
                        Device& device) {
  const Stopwatch watch;
  device.take_stage_times();  // of whatever came before
  EditResult result = Edit(pair, handles, method, device).solve();
  result.warnings.insert(result.warnings.begin(), pair.warnings.begin(), pair.warnings.end());
  result.total_ms = watch.milliseconds();
  return result;
}

std::unique_ptr<Problem> make_edit_problem(const FramePair& pair, const NamedHandles& handles,
                                           const NonRigidMethod& method, Device& device) {
  return Edit(pair, handles, method, device).take_problem();
}

}  // namespace pliant
