#include "experiments/tasks/track_artefacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

using nlohmann::ordered_json;
using FrameFigures = TrackSummary::FrameFigures;

ordered_json run_json(const ExperimentRun& run, const TrackSummary& summary, const TrackEnd& end) {
  ordered_json json = {{"name", run.name},
                       {"frames", summary.frames.size()},
                       {"waiting", summary.count(FrameState::waiting)},
                       {"tracked", summary.count(FrameState::tracked)},
                       {"lost", summary.count(FrameState::lost)},
                       {"relocalized", summary.relocalized},
                       {"registered", summary.count(&FrameFigures::is_registered)},
                       {"rejected", summary.count(&FrameFigures::is_rejected)},
                       {"warnings", end.warnings},
                       {"broken_by", end.error},
                       {"frame_ms", summary.mean_ms()},
                       {"time_ms", summary.time_ms}};
  if (summary.count(FrameState::tracked) > 0)
    json.update({{"mean_error", summary.mean(&FrameFigures::mean_error)},
                 {"rigid_error_mean", summary.mean(&FrameFigures::rigid_error)},
                 {"error_mean", summary.mean(&FrameFigures::error)},
                 {"error_sd", summary.mean(&FrameFigures::deviation)}});
  if (const auto rmse = summary.rmse())
    json["truth"] = {{"ate_translation", rmse->translation}, {"ate_rotation", rmse->rotation}};
  if (summary.knows(&FrameFigures::point_error))
    json["truth"].update({{"point_error", summary.mean(&FrameFigures::point_error)},
                          {"point_error_moving", summary.mean(&FrameFigures::moving_error)}});
  if (const auto& error = end.model_error)
    json["truth"].update({{"model_mean", error->mean}, {"model_p95", error->p95}});
  if (const FocalLengthEstimate& focal = end.focal_length; focal.views > 0)
    json["focal_length"] = {{"change", focal.change}, {"error", focal.error}, {"views", focal.views}};
  return json;
}

Table summary_table(const std::string& name, const TrackSummary& summary, const TrackEnd& end) {
  const auto rmse = summary.rmse();
  const auto known = [](bool is_known, const char* format, double value) {
    return is_known ? fmt::format(fmt::runtime(format), value) : "unknown";
  };
  const PoseError error = rmse.value_or(PoseError{});
  const bool is_tracked = summary.count(FrameState::tracked) > 0;
  return {"",
          {"run", "frames", "tracked", "lost", "registered", "error mm", "SD mm", "ATE mm", "ATE degrees",
           "model mm", "frame ms", "frames/s"},
          {{{name, std::to_string(summary.frames.size()), std::to_string(summary.count(FrameState::tracked)),
             std::to_string(summary.count(FrameState::lost)),
             std::to_string(summary.count(&FrameFigures::is_registered)),
             known(is_tracked, "{:.2f}", summary.mean(&FrameFigures::error)),
             known(is_tracked, "{:.2f}", summary.mean(&FrameFigures::deviation)),
             known(rmse.has_value(), "{:.2f}", error.translation),
             known(rmse.has_value(), "{:.3f}", error.rotation),
             known(end.model_error.has_value(), "{:.2f}", end.model_error.value_or(ModelError{}).mean),
             fmt::format("{:.1f}", summary.mean_ms()),
             summary.mean_ms() > 0 ? fmt::format("{:.1f}", 1e3 / summary.mean_ms()) : "unknown"}}}};
}

Table stages_table(const TrackSummary& summary) {
  Table table{"Time a frame", {}, {}};
  for (const auto& [stage, time] : summary.time_ms)
    table.rows.push_back(
        {{stage, fmt::format("{:.2f} ms", time / std::max(summary.count(FrameState::tracked) - 1, 1))}});
  return table;
}

/// A number of each frame; 0 where there is none.
Series series_of(const TrackSummary& summary, const std::string& title, const std::string& value,
                 float FrameFigures::*member) {
  Series series{title, "frame", value, {}};
  for (const FrameFigures& frame : summary.frames)
    series.values.push_back(std::isnan(frame.*member) ? 0 : static_cast<double>(frame.*member));
  return series;
}

std::vector<std::string> notes_of(const TrackSummary& summary, const TrackEnd& end) {
  std::vector<std::string> notes{fmt::format("{} of {} frames tracked, {} lost",
                                             summary.count(FrameState::tracked), summary.frames.size(),
                                             summary.count(FrameState::lost))};
  if (const int waiting = summary.count(FrameState::waiting); waiting > 0)
    notes.push_back(fmt::format("{} frames were waited for one that shows the object", waiting));
  if (summary.relocalized > 0)
    notes.push_back(
        fmt::format("{} of the tracked frames were found by relocalisation", summary.relocalized));
  if (end.is_ended) notes.emplace_back("ended early, as asked");
  if (!end.error.empty()) notes.push_back("the frames ended early: " + end.error);
  for (const auto& warning : end.warnings) notes.push_back("warning: " + warning);
  return notes;
}

}  // namespace

RunArtefacts track_artefacts(const ExperimentRun& run, const TrackSummary& summary, const TrackEnd& end) {
  RunArtefacts made{
      {run.name, run_json(run, summary, end), summary_table(run.name, summary, end), notes_of(summary, end)}};
  if (!end.error.empty()) {
    made.failure = run.place + ": " + end.error;
    made.is_short_of_data = true;
  }
  made.lead =
      fmt::format("{} frames, tracked against a model that they are fused into", summary.frames.size());
  made.tables = {stages_table(summary)};
  made.series = {series_of(summary, "Error of rigid tracking", "mm", &FrameFigures::rigid_error),
                 series_of(summary, "Error", "mm", &FrameFigures::error),
                 series_of(summary, "Points of the model with a match", "share", &FrameFigures::inlier_share),
                 series_of(summary, "Time", "ms", &FrameFigures::total_ms)};
  if (summary.rmse())
    made.series.push_back(
        series_of(summary, "Distance from the true position", "mm", &FrameFigures::translation_error));
  return made;
}

}  // namespace pliant
