#include "experiments/runner/result_json.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "experiments/runner/version.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

ordered_json metrics_json(const Metrics& metrics) {
  ordered_json json = {{"residual_mean", metrics.residual_mean},
                       {"residual_sd", metrics.residual_sd},
                       {"coverage", metrics.coverage},
                       {"nearest_mean", metrics.nearest_mean},
                       {"nearest_sd", metrics.nearest_sd}};
  if (!metrics.truth) return json;
  json["epe_mean"] = metrics.truth->epe_mean;
  json["epe_sd"] = metrics.truth->epe_sd;
  json["epe_p95"] = metrics.truth->epe_p95;
  json["epe_moving_mean"] = metrics.truth->epe_moving_mean;
  json["epe_seen_mean"] = metrics.truth->epe_seen_mean;
  json["epe_hidden_mean"] = metrics.truth->epe_hidden_mean;
  json["hidden_share"] = metrics.truth->hidden_share;
  return json;
}

ordered_json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// The rotation as axis times degrees, the translation in mm.
ordered_json alignment_json(const AlignmentResult& alignment) {
  const Eigen::AngleAxisd turn(alignment.motion.rotation());
  return {{"method", alignment.method},
          {"reason", alignment.reason},
          {"matches", alignment.matches},
          {"inliers", alignment.inliers},
          {"rotation", vector_json(turn.axis() * turn.angle() * 180 / EIGEN_PI)},
          {"translation", vector_json(alignment.motion.translation())}};
}

ordered_json counts_json(const RegistrationResult::Counts& counts) {
  return {{"source_points", counts.source_points},
          {"matched_points", counts.matched_points},
          {"nodes", counts.nodes},
          {"edges", counts.edges},
          {"constraints", counts.constraints},
          {"unknowns", counts.unknowns},
          {"outer_iterations", counts.outer_iterations},
          {"solver_iterations", counts.solver_iterations}};
}

ordered_json energy_json(const RegistrationResult::Energy& energy) {
  return {{"initial", energy.initial}, {"final", energy.final}, {"per_iteration", energy.per_iteration}};
}

ordered_json time_json(double total, const StageTimes& stages) {
  ordered_json times = {{"total", total}};
  for (const auto& [stage, milliseconds] : stages) times[stage] = milliseconds;
  return times;
}

ordered_json timing_json(double median, const Timing& timing) {
  return {{"repeats", timing.repeats},
          {"median_ms", median},
          {"min_ms", timing.min_ms},
          {"max_ms", timing.max_ms},
          {"built_kernels", timing.built_kernels}};
}

ordered_json solver_json(const RegistrationResult::SolverRecord& solver) {
  return {
      {"name", solver.name}, {"linear_solver", solver.linear_solver}, {"termination", solver.termination}};
}

template <class Record>
ordered_json make_result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                              const std::vector<Record>& runs) {
  ordered_json list = ordered_json::array();
  for (const auto& run : runs) list.push_back(run_json(run));
  return {{"schema", 1},
          {"experiment", plan.experiment.to_json()},
          {"environment", environment_json(device, plan)},
          {"runs", list}};
}

void check_finite(const ordered_json& json, const std::string& key) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw NumericalError(fmt::format("{} is {}; there is no finite answer", key, json.get<double>()));
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) check_finite(value, key.empty() ? name : key + "." + name);
  }
  if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) check_finite(json[i], fmt::format("{}[{}]", key, i));
  }
}

}  // namespace

ordered_json environment_json(const DeviceInfo& device, const ExperimentPlan& plan) {
  ordered_json libraries_json = ordered_json::object();
  for (const auto& [name, number] : libraries()) libraries_json[name] = number;
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {{"version", version()},
          {"commit", commit()},
          {"device", device.name},
          {"opencl_driver", fmt::format("{} {} ({})", device.platform, device.driver, device.version)},
          {"libraries", libraries_json},
          {"seed", plan.experiment.values.integer("seed")},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))}};
}

ordered_json run_json(const RunRecord& run) {
  const RegistrationResult& result = run.result;
  ordered_json history = ordered_json::array();
  for (const auto& step : result.history)
    history.push_back(
        {{"residual_mean", step.residual_mean}, {"robust", step.robust}, {"matched", step.matched}});
  return {{"name", run.name},
          {"termination", result.termination},
          {"reason", result.reason},
          {"warnings", result.warnings},
          {"alignment", alignment_json(result.alignment)},
          {"counts", counts_json(result.counts)},
          {"metrics", metrics_json(run.metrics)},
          {"initial", metrics_json(run.initial)},
          {"aligned", metrics_json(run.aligned)},
          {"history", history},
          {"returned_iteration", result.returned_iteration},
          {"energy", energy_json(result.energy)},
          {"time_ms", time_json(result.total_ms, result.time_ms)},
          {"timing", timing_json(result.total_ms, run.timing)},
          {"solver", solver_json(result.solver)}};
}

ordered_json run_json(const EditRecord& run) {
  const EditResult& result = run.result;
  ordered_json counts = counts_json(result.counts);
  for (const char* of_matching : {"matched_points", "outer_iterations"}) counts.erase(of_matching);
  ordered_json handles = ordered_json::object();
  for (const auto& handle : result.handles)
    handles[handle.name] = {{"points", handle.points},
                            {"residual_initial_mean", handle.initial_mean},
                            {"residual_mean", handle.mean},
                            {"residual_max", handle.max}};
  const auto all = result.all_handles();
  return {{"name", run.name},
          {"warnings", result.warnings},
          {"counts", counts},
          {"metrics", {{"handle_residual_mean", all.mean}, {"handle_residual_max", all.max}}},
          {"initial", {{"handle_residual_mean", all.initial_mean}}},
          {"handles", handles},
          {"energy", energy_json(result.energy)},
          {"time_ms", time_json(result.total_ms, result.time_ms)},
          {"timing", timing_json(result.total_ms, run.timing)},
          {"solver", solver_json(result.solver)}};
}

ordered_json result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                         const std::vector<RunRecord>& runs) {
  return make_result_json(plan, device, runs);
}

ordered_json result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                         const std::vector<EditRecord>& runs) {
  return make_result_json(plan, device, runs);
}

void write_json(const std::string& path, const ordered_json& json) {
  check_finite(json, "");
  const std::string text = json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  write_file(path, {text.begin(), text.end()});
}

}  // namespace pliant
