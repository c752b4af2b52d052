#include "experiments/tasks/registration_artefacts.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "experiments/report/heat_map.h"
#include "experiments/tasks/drawings.h"
#include "experiments/tasks/result_parts.h"
#include "framework/core/angle.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

ordered_json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

double degrees(const Eigen::AngleAxisd& turn) { return turn.angle() / degree; }

/// The rotation as axis times degrees, the translation in mm.
ordered_json alignment_json(const AlignmentResult& alignment) {
  const Eigen::AngleAxisd turn(alignment.motion.rotation());
  return {{"method", alignment.method},
          {"reason", alignment.reason},
          {"matches", alignment.matches},
          {"inliers", alignment.inliers},
          {"rotation", vector_json(turn.axis() * turn.angle() / degree)},
          {"translation", vector_json(alignment.motion.translation())}};
}

ordered_json history_json(const RegistrationResult& result) {
  ordered_json history = ordered_json::array();
  for (const auto& step : result.history)
    history.push_back(
        {{"residual_mean", step.residual_mean}, {"robust", step.robust}, {"matched", step.matched}});
  return history;
}

ordered_json run_json(const std::string& name, const RegistrationResult& result, const Measured& measured,
                      const Timing& timing) {
  return {{"name", name},
          {"termination", result.termination},
          {"reason", result.reason},
          {"warnings", result.warnings},
          {"alignment", alignment_json(result.alignment)},
          {"counts", counts_json(result.counts)},
          {"metrics", metrics_json(measured.final.metrics)},
          {"initial", metrics_json(measured.initial.metrics)},
          {"aligned", metrics_json(measured.aligned.metrics)},
          {"history", history_json(result)},
          {"returned_iteration", result.returned_iteration},
          {"energy", energy_json(result.energy)},
          {"time_ms", timing.stages_json()},
          {"timing", timing.json()},
          {"solver", solver_json(result.solver)}};
}

Table summary(const std::string& name, const RegistrationResult& result, const Measured& measured,
              const Timing& timing) {
  const Metrics& before = measured.initial.metrics;
  const Metrics& after = measured.final.metrics;
  const std::string epe =
      before.truth && after.truth ? change(before.truth->epe_mean, after.truth->epe_mean) : "unknown";
  return {
      "",
      {"run", "nodes", "constraints", "iterations", "residual mm", "nearest mm", "EPE mm", "time ms"},
      {{{name, std::to_string(result.counts.nodes), std::to_string(result.counts.constraints),
         std::to_string(result.counts.outer_iterations), change(before.residual_mean, after.residual_mean),
         change(before.nearest_mean, after.nearest_mean), epe, timing.text()}}}};
}

std::string ending(const RegistrationResult& result) {
  return fmt::format("{}{} after {} outer iterations; {} with {}", result.termination,
                     result.reason.empty() ? "" : " (" + result.reason + ")", result.counts.outer_iterations,
                     result.solver.name, result.solver.linear_solver);
}

Table method_table(const RegistrationResult& result) {
  const AlignmentResult& alignment = result.alignment;
  const std::string matches = alignment.matches == 0
                                  ? "none used"
                                  : fmt::format("{} of {} agree", alignment.inliers, alignment.matches);
  const auto with_reason = [](const std::string& what, const std::string& reason) {
    return reason.empty() ? what : what + ": " + reason;
  };
  return {"Method",
          {},
          {{{"Solver", result.solver.name}},
           {{"Linear solver", result.solver.linear_solver}},
           {{"Last solve ended", result.solver.termination}},
           {{"Registration ended", with_reason(result.termination, result.reason)}},
           {{"Aligned by", with_reason(alignment.method, alignment.reason)}},
           {{"Feature matches", matches}},
           {{"Initial rotation",
             fmt::format("{:.2f} degrees", degrees(Eigen::AngleAxisd(alignment.motion.rotation())))}},
           {{"Initial translation", fmt::format("{:.1f} mm", alignment.motion.translation().norm())}}}};
}

Series residual_series(const RegistrationResult& result) {
  Series series{"Residual", "outer iteration", "robust residual, mm", {}};
  for (const auto& step : result.history) series.values.push_back(step.robust);
  series.note = fmt::format("The result is that of iteration {}.", result.returned_iteration);
  return series;
}

/// Adds what the adaptive parts chose; what stayed the same needs no plot.
void add_growth(const GraphGrowth& growth, std::vector<Series>& series) {
  const auto add = [&](const std::string& title, const std::string& value, const std::vector<double>& sizes) {
    const bool varies = std::adjacent_find(sizes.begin(), sizes.end(), std::not_equal_to<>()) != sizes.end();
    if (varies) series.push_back({title, "outer iteration", value, sizes});
  };
  add("Graph", "nodes", growth.nodes);
  add("Constraints", "constrained points", growth.constraints);
}

Image<float> target_depth(const SurfaceImage& target) {
  Image<float> image(target.points.width(), target.points.height(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const float depth = target.points.data()[i].z();
    if (depth > 0) image.data()[i] = depth;
  }
  return image;
}

/// Fits what non-rigid registration starts from: before the alignment errors may be a hundred times as
/// large, and nothing would be seen of the end.
ColorScale error_scale(const std::vector<float>& aligned) {
  const float bulk = std::max(quantile(aligned, 0.95), 0.1f);
  return {ColorScale::Map::error, 0, static_cast<float>(round_up(bulk))};
}

Picture draw_error(const std::string& name, const std::string& caption, const Surface& source,
                   const Camera& camera, const ColorScale& scale, const Measured::Stage& stage) {
  return heat_map(name, caption, at_pixels(source, camera, stage.nearest), scale,
                  fmt::format("to the nearest target point: mean {:.2f} mm, sd {:.2f} mm",
                              stage.metrics.nearest_mean, stage.metrics.nearest_sd));
}

/// Nodes are known as the alignment moved them.
std::vector<Eigen::Vector3d> nodes_as_given(const RegistrationResult& result) {
  const Eigen::Isometry3d undo = result.alignment.motion.inverse();
  std::vector<Eigen::Vector3d> nodes;
  for (const Eigen::Vector3f& node : result.node_positions) nodes.push_back(undo * node.cast<double>());
  return nodes;
}

/// Depths share one colour scale, errors another, in mm.
std::vector<Picture> pictures(const RegistrationResult& result, const Camera& camera,
                              const SurfaceImage& target, const Measured& measured) {
  const Surface& source = result.source;
  const ColorScale depth = depth_scale(source, result.points);
  const ColorScale error = error_scale(measured.aligned.nearest);
  const Image<float> behind = target_depth(target);
  const auto target_points =
      std::count_if(behind.pixels().begin(), behind.pixels().end(), [](float value) { return value > 0; });
  std::vector<Picture> pictures{
      draw_source(source, camera, depth),
      heat_map("depth_target", "Target depth", behind, depth, fmt::format("{} points", target_points)),
      draw_error("error_initial", "Error before registration", source, camera, error, measured.initial)};
  if (result.aligned_points != source.points)
    pictures.push_back(draw_error("error_aligned", "Error after the initial alignment", source, camera, error,
                                  measured.aligned));
  pictures.push_back(
      draw_error("error_final", "Error after registration", source, camera, error, measured.final));
  pictures.push_back(draw_last_graph(source, camera, nodes_as_given(result), result.graph_cells));
  return pictures;
}

std::vector<NamedSurface> surfaces(const RegistrationResult& result, const Surface& target,
                                   const Measured& measured) {
  NamedSurface registered{"registered", result.source, measured.final.nearest, result.matched,
                          result.source.points};
  registered.surface.points = result.points;
  registered.surface.normals = result.normals;
  return {{"source", result.source, measured.initial.nearest},
          {"target", target, std::vector<float>(target.size(), 0)},
          std::move(registered)};
}

}  // namespace

RunArtefacts registration_artefacts(const ExperimentRun& run, const FramePair& pair,
                                    const SurfaceImage& target, const RegistrationResult& result,
                                    const Measured& measured, const GraphGrowth& growth,
                                    const Timing& timing) {
  RunArtefacts made{{run.name, run_json(run.name, result, measured, timing),
                     summary(run.name, result, measured, timing),
                     notes_of(ending(result), result.warnings, timing)}};
  if (result.termination == "failed")
    made.failure = fmt::format("{}: {}; the result is that of iteration {}", run.place, result.reason,
                               result.returned_iteration);
  made.lead = "Non-rigid registration of " + pair.name;
  made.tables = {metrics_table(measured), counts_table(result.counts), method_table(result), timing.table()};
  made.series = {energy_series(result.energy, "outer iteration"), residual_series(result)};
  add_growth(growth, made.series);
  made.pictures = pictures(result, pair.camera, target, measured);
  made.surfaces = surfaces(result, make_surface(target, pair.target.color), measured);
  return made;
}

}  // namespace pliant
