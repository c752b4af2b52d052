#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "experiments/report/surfaces.h"
#include "experiments/tasks/drawings.h"
#include "experiments/tasks/result_parts.h"
#include "experiments/tasks/task.h"
#include "framework/geometry/render.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

ordered_json run_json(const std::string& name, const EditResult& result, const Timing& timing) {
  ordered_json counts = counts_json(result.counts);
  for (const char* of_matching : {"matched_points", "outer_iterations"}) counts.erase(of_matching);
  ordered_json handles = ordered_json::object();
  for (const auto& handle : result.handles)
    handles[handle.name] = {{"points", handle.points},
                            {"residual_initial_mean", handle.initial_mean},
                            {"residual_mean", handle.mean},
                            {"residual_max", handle.max}};
  const auto all = result.all_handles();
  return {{"name", name},
          {"warnings", result.warnings},
          {"counts", counts},
          {"metrics", {{"handle_residual_mean", all.mean}, {"handle_residual_max", all.max}}},
          {"initial", {{"handle_residual_mean", all.initial_mean}}},
          {"handles", handles},
          {"energy", energy_json(result.energy)},
          {"time_ms", timing.stages_json()},
          {"timing", timing.json()},
          {"solver", solver_json(result.solver)}};
}

Table summary(const std::string& name, const EditResult& result, const Timing& timing) {
  const auto all = result.all_handles();
  return {"",
          {"run", "nodes", "held points", "iterations", "handles mm", "energy", "time ms"},
          {{{name, std::to_string(result.counts.nodes), std::to_string(result.counts.constraints),
             std::to_string(result.counts.solver_iterations), change(all.initial_mean, all.mean),
             fmt::format("{:.4g} -> {:.4g}", result.energy.initial, result.energy.final), timing.text()}}}};
}

std::string ending(const EditResult& result) {
  return fmt::format("{} after {} iterations; {} with {}", result.solver.termination,
                     result.counts.solver_iterations, result.solver.name, result.solver.linear_solver);
}

Table handles_table(const EditResult& result) {
  Table table{"Handles: distance in mm of the points that they hold from where they want them",
              {"", "points", "initial mean", "final mean", "final maximum"},
              {},
              3};
  for (const auto& handle : result.handles)
    table.rows.push_back(
        {{handle.name, std::to_string(handle.points), fmt::format("{:.2f}", handle.initial_mean),
          fmt::format("{:.3f}", handle.mean), fmt::format("{:.3f}", handle.max)}});
  return table;
}

Table method_table(const EditResult& result) {
  return {"Method",
          {},
          {{{"Solver", result.solver.name}},
           {{"Linear solver", result.solver.linear_solver}},
           {{"The solve ended", result.solver.termination}}}};
}

/// What the camera would see of the bent surface.
Image<float> see_bent(const EditResult& result, const Camera& camera) {
  constexpr float depth_step = 20;  // mm, within which neighbouring pixels are one surface
  std::vector<Eigen::Vector3d> vertices;
  for (const Eigen::Vector3f& point : result.points) vertices.push_back(point.cast<double>());
  Image<float> seen = depth_of(render_mesh(vertices, triangulate(result.source, depth_step), camera));
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen.data()[i] <= 0) seen.data()[i] = std::numeric_limits<float>::quiet_NaN();
  return seen;
}

/// How far each point went, mm.
std::vector<float> lengths_of_motion(const EditResult& result) {
  std::vector<float> lengths;
  for (std::size_t i = 0; i < result.points.size(); ++i)
    lengths.push_back((result.points[i] - result.source.points[i]).norm());
  return lengths;
}

std::vector<Picture> pictures(const EditResult& result, const Camera& camera,
                              const std::vector<float>& lengths) {
  const ColorScale depth = depth_scale(result.source, result.points);
  const float longest = lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
  const ColorScale motion{ColorScale::Map::error, 0, static_cast<float>(round_up(std::max(longest, 0.1F)))};
  std::vector<Eigen::Vector3d> nodes;
  for (const Eigen::Vector3f& node : result.node_positions) nodes.push_back(node.cast<double>());
  return {draw_source(result.source, camera, depth),
          heat_map("depth_registered", "Depth of the bent surface", see_bent(result, camera), depth,
                   "as the same camera would see it"),
          heat_map("motion", "How far each point went", at_pixels(result.source, camera, lengths), motion,
                   fmt::format("at most {:.1f} mm", longest)),
          draw_last_graph(result.source, camera, nodes, result.graph_cells)};
}

/// The bent surface under the name of a registered one; its errors are how far each point went.
std::vector<NamedSurface> surfaces(const EditResult& result, const std::vector<float>& lengths) {
  NamedSurface bent{"registered", result.source, lengths, {}, result.source.points};
  bent.surface.points = result.points;
  bent.surface.normals = result.normals;
  return {{"source", result.source, std::vector<float>(result.source.size(), 0)}, std::move(bent)};
}

class EditTask : public Task {
 public:
  ArtefactNames names() const override {
    return {{"depth_source", "depth_registered", "motion", "graph"}, {"source", "registered"}};
  }

  std::vector<std::string> check(const ExperimentRun& run, Workbench& workbench) const override {
    make_method(run, workbench.registry());
    const FramePair& pair = workbench.pair(run.values);
    workbench.device(run.values);
    const Surface source = told_with_place(run.place, [&] { return source_surface(pair); });
    for (const auto& [name, handle] : make_handles(run, workbench.registry())) take_hold(handle, source);
    return pair.warnings;
  }

  RunArtefacts make(const ExperimentRun& run, Workbench& workbench, const Making& making) const override {
    const FramePair& pair = workbench.pair(run.values);
    const Method method = make_method(run, workbench.registry());
    const NamedHandles handles = make_handles(run, workbench.registry());
    Device& device = workbench.device(run.values);
    Timing timing;
    const EditResult result = told_with_place(run.place, pair, [&] {
      return make_timed(device, making.repeats, timing,
                        [&](const std::string&) { return edit_surface(pair, handles, method, device); });
    });
    RunArtefacts made{{run.name, run_json(run.name, result, timing), summary(run.name, result, timing),
                       notes_of(ending(result), result.warnings, timing)}};
    const std::vector<float> lengths = lengths_of_motion(result);
    made.lead = "The source of " + pair.name + ", bent by handles";
    made.tables = {handles_table(result), counts_table(result.counts), method_table(result), timing.table()};
    made.series = {energy_series(result.energy, "iteration of the solver")};
    made.pictures = pictures(result, pair.camera, lengths);
    made.surfaces = surfaces(result, lengths);
    return made;
  }
};

}  // namespace

std::unique_ptr<Task> make_edit_task() { return std::make_unique<EditTask>(); }

}  // namespace pliant
