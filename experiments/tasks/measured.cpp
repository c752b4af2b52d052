#include "experiments/tasks/measured.h"

#include <fmt/format.h>

#include <functional>

namespace pliant {
namespace {

std::string with_sd(double mean, double sd) { return fmt::format("{:.2f} ± {:.2f}", mean, sd); }

/// Adds a row; `cell` writes one of its three values.
void add_row(Table& table, const Measured& measured, const char* name,
             const std::function<std::string(const Metrics&)>& cell) {
  table.rows.push_back(
      {{name, cell(measured.initial.metrics), cell(measured.aligned.metrics), cell(measured.final.metrics)}});
}

void add_truth_row(Table& table, const Measured& measured, const char* name,
                   const std::function<std::string(const Metrics::Truth&)>& cell) {
  add_row(table, measured, name,
          [&](const Metrics& metrics) { return metrics.truth ? cell(*metrics.truth) : std::string("–"); });
}

}  // namespace

Measured measure(const Evaluation& evaluation, const RegistrationResult& result,
                 const ProgressSink& progress) {
  progress({"", 1, "measuring distances"});
  const auto stage = [&](const std::vector<Eigen::Vector3f>& points) {
    const auto nearest = evaluation.nearest(points, [&](double share) {
      progress({"", 1, fmt::format("measuring distances: {:.0f} %", 100 * share)});
    });
    return Measured::Stage{nearest, evaluation.measure(points, nearest)};
  };
  const Measured::Stage initial = stage(result.source.points);
  const bool is_aligned = result.aligned_points != result.source.points;
  return {initial, is_aligned ? stage(result.aligned_points) : initial, stage(result.points)};
}

nlohmann::ordered_json metrics_json(const Metrics& metrics) {
  nlohmann::ordered_json json = {{"residual_mean", metrics.residual_mean},
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

Table metrics_table(const Measured& measured) {
  using Truth = Metrics::Truth;
  Table table{"Distances in mm, mean ± standard deviation", {"", "initial", "aligned", "final"}, {}, 3};
  add_row(table, measured, "Residual, to the target at the same pixel",
          [](const Metrics& metrics) { return with_sd(metrics.residual_mean, metrics.residual_sd); });
  add_row(table, measured, "Coverage (points that have such a pixel)",
          [](const Metrics& metrics) { return fmt::format("{:.1f} %", 100 * metrics.coverage); });
  add_row(table, measured, "To the nearest target point",
          [](const Metrics& metrics) { return with_sd(metrics.nearest_mean, metrics.nearest_sd); });
  if (!measured.final.metrics.truth) return table;
  add_truth_row(table, measured, "To the true position (EPE)",
                [](const Truth& truth) { return with_sd(truth.epe_mean, truth.epe_sd); });
  add_truth_row(table, measured, "EPE, 95th percentile",
                [](const Truth& truth) { return fmt::format("{:.2f}", truth.epe_p95); });
  add_truth_row(table, measured, "EPE of points that truly move",
                [](const Truth& truth) { return fmt::format("{:.2f}", truth.epe_moving_mean); });
  return table;
}

}  // namespace pliant
