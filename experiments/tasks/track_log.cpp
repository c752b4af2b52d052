#include "experiments/tasks/track_log.h"

#include <fmt/format.h>

#include "framework/io/trajectory_file.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

constexpr const char* csv_header =
    "frame,time_s,state,x_mm,y_mm,z_mm,samples,inliers,mean_error_mm,conditioning,iterations,total_ms,"
    "translation_error_mm,rotation_error_deg,relocalized,rigid_error_mean_mm,error_mean_mm,error_sd_mm,"
    "registered,"
    "rejected,point_error_mm,point_error_moving_mm\n";

/// The rows of [R | t], mm.
ordered_json rows_of(const Eigen::Isometry3d& pose) {
  auto rows = ordered_json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({pose(row, 0), pose(row, 1), pose(row, 2), pose(row, 3)});
  return rows;
}

ordered_json json_of(const PointErrors& errors) {
  return {{"count", errors.count}, {"mean", errors.mean}, {"p95", errors.p95}, {"max", errors.max}};
}

ordered_json json_of(const FrameRecord& record, const std::optional<PoseError>& error,
                     const std::optional<FollowedErrors>& points) {
  const PoseEstimate& pose = record.pose;
  ordered_json json = {{"frame", record.number},
                       {"time", record.time},
                       {"state", to_string(record.state)},
                       {"reason", record.reason},
                       {"relocalized", record.relocalized},
                       {"camera_from_model", rows_of(record.camera_from_model)},
                       {"samples", pose.samples},
                       {"inliers", pose.inliers},
                       {"mean_error", pose.mean_error},
                       {"conditioning", pose.conditioning},
                       {"iterations", pose.iterations},
                       {"rigid_error_mean", record.rigid_error.mean},
                       {"rigid_error_sd", record.rigid_error.deviation},
                       {"error_mean", record.error.mean},
                       {"error_sd", record.error.deviation},
                       {"matched", record.error.matched},
                       {"registered", is_registered(record)},
                       {"rejected", is_rejected(record)},
                       {"total_ms", record.total_ms},
                       {"time_ms", record.time_ms}};
  if (const auto& registration = record.registration)
    json["registration"] = {{"reason", registration->reason},
                            {"iterations", registration->iterations},
                            {"nodes", registration->nodes},
                            {"constraints", registration->constraints},
                            {"folded_cells", registration->folded_cells}};
  if (error) json["error"] = {{"translation", error->translation}, {"rotation", error->rotation}};
  if (points) {
    json["points"] = {{"all", json_of(points->all)},
                      {"visible", json_of(points->visible)},
                      {"moving", json_of(points->moving)}};
    json["point_error"] = points->visible.mean;
    json["point_error_moving"] = points->moving.mean;
  }
  return json;
}

std::string csv_of(const FrameRecord& record, const std::optional<PoseError>& error,
                   const std::optional<FollowedErrors>& points) {
  const Eigen::Vector3d place = record.camera_from_model.inverse().translation();
  const PoseEstimate& pose = record.pose;
  return fmt::format(
      "{},{},{},{:.3f},{:.3f},{:.3f},{},{},{:.4f},{:.3g},{},{:.3f},{},{:d},{:.4f},{:.4f},{:.4f},{:d},{:d},{}"
      "\n",
      record.number, record.time, to_string(record.state), place.x(), place.y(), place.z(), pose.samples,
      pose.inliers, pose.mean_error, pose.conditioning, pose.iterations, record.total_ms,
      error ? fmt::format("{:.4f},{:.5f}", error->translation, error->rotation) : ",", record.relocalized,
      record.rigid_error.mean, record.error.mean, record.error.deviation, is_registered(record),
      is_rejected(record),
      points ? fmt::format("{:.4f},{:.4f}", points->visible.mean, points->moving.mean) : ",");
}

std::string path_of(const std::filesystem::path& folder, std::size_t file) {
  return (folder / TrackLog::files()[file]).string();
}

}  // namespace

const std::vector<std::string>& TrackLog::files() {
  static const std::vector<std::string> names{"frames.jsonl", "frames.csv", "trajectory.txt"};
  return names;
}

TrackLog::TrackLog(const std::filesystem::path& folder)
    : json_(path_of(folder, 0)), csv_(path_of(folder, 1)), trajectory_(path_of(folder, 2)) {
  csv_.append(csv_header);
}

void TrackLog::add(const FrameRecord& record, const std::optional<PoseError>& error,
                   const std::optional<FollowedErrors>& points) {
  json_.append(json_of(record, error, points));
  csv_.append(csv_of(record, error, points));
  if (has_pose(record.state))
    trajectory_.append(trajectory_line({record.time, record.camera_from_model.inverse()}));
}

}  // namespace pliant
