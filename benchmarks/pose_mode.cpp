#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/bench.h"
#include "benchmarks/opencv_icp.h"
#include "experiments/datasets/frame_source.h"
#include "experiments/program/folders.h"
#include "experiments/runner/components.h"
#include "framework/config/config.h"
#include "framework/core/error.h"
#include "framework/core/stopwatch.h"
#include "framework/evaluation/trajectory_error.h"
#include "framework/imaging/bilateral.h"
#include "framework/imaging/depth_map.h"
#include "framework/io/text_lines.h"
#include "framework/pose/pose_estimator.h"

namespace pliant::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// A sequence whose camera poses are known.
struct KnownSequence {
  const char* name;
  const char* needs;  ///< data that not every machine has; empty: none
  const char* poses;  ///< their file in the data folders; empty: the stream knows them
};

constexpr std::array sequences{
    KnownSequence{"head", "", ""},
    KnownSequence{"sheet", "", ""},
    KnownSequence{"room", "", ""},
    KnownSequence{"livingroom", "icl_livingroom60/depth", "icl_livingroom60/poses.txt"},
};

Parameters read_experiment(const std::string& name, const Registry& registry) {
  const fs::path file = fs::path(PLIANT_SOURCE_FOLDER) / "benchmarks" / "sequences" / (name + ".yaml");
  return load_experiment({file, {}, data_folders("")},
                         {component("data", FrameSource::kind),
                          component("pose", PoseEstimatorKind::kind, "icp_projective")},
                         registry)
      .values;
}

/// Lines of a frame's number and a 4x4 matrix from its camera to the world, row by row, in metres.
std::vector<Eigen::Isometry3d> read_matrices(const std::string& path) {
  TextLines lines(path);
  std::vector<Eigen::Isometry3d> poses;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    Eigen::Isometry3d pose;
    for (std::size_t i = 0; i < 16; ++i)
      pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
          lines.real(*line, 1 + i);
    pose.translation() *= 1000;
    poses.push_back(pose);
  }
  return poses;
}

/// Poses of a camera that are chained from frame to frame.
struct Chain {
  Trajectory trajectory;
  int failures = 0;
  double time_ms = std::numeric_limits<double>::infinity();  ///< the least: what else runs only adds to it

  void add(double time, const std::optional<Eigen::Isometry3d>& target_from_source) {
    Eigen::Isometry3d pose = trajectory.empty() ? Eigen::Isometry3d::Identity() : trajectory.back().pose;
    if (target_from_source) pose = pose * target_from_source->inverse();
    trajectory.push_back({time, pose});
  }

  ordered_json row(const Trajectory& truth) const {
    const TrajectoryError absolute = absolute_error(trajectory, truth, TrajectoryAlignment::first);
    const TrajectoryError relative = relative_error(trajectory, truth);
    return {{"failures", failures},
            {"drift_mm", relative.translation},
            {"drift_degrees", relative.rotation},
            {"error_mm", absolute.translation},
            {"error_degrees", absolute.rotation},
            {"time_ms", time_ms}};
  }
};

/// Both trackers on one sequence, each frame against the one before.
ordered_json track(const KnownSequence& sequence, int most_frames, const Registry& registry, Device& device) {
  const Parameters experiment = read_experiment(sequence.name, registry);
  const auto stream = registry.make<FrameSource>(experiment.section("data"))->open(device, 1);
  const auto estimator = registry.make<PoseEstimatorKind>(experiment.section("pose"))->make(device);
  const auto known =
      *sequence.poses == '\0'
          ? std::vector<Eigen::Isometry3d>()
          : read_matrices((*find_data(data_folders(""), sequence.poses) / sequence.poses).string());
  const Camera& camera = stream->rig().depth;
  const OpencvIcp opencv(camera);
  const BilateralFilter filter(4.5, 30, 6);
  std::optional<SurfaceMap> before;
  OpencvIcp::Frame opencv_before;
  Chain ours;
  Chain theirs;
  Trajectory truth;
  CheckedStream checked(*stream);
  while (const auto frame = checked.next()) {
    const int number = static_cast<int>(truth.size()) + 1;
    if (number > most_frames) break;
    truth.push_back({frame->time, known.empty() ? *stream->camera_pose(number)
                                                : known.at(static_cast<std::size_t>(number - 1))});
    DepthMap depth(*frame);
    if (auto filtered = filter.filter(device, depth, camera)) depth = std::move(*filtered);
    SurfaceMap map = make_surface_map(device, depth, camera);
    device.finish();
    const cv::Mat in_metres = OpencvIcp::depth_of(frame->depth);
    const Stopwatch watch;
    OpencvIcp::Frame opencv_frame = opencv.prepare(in_metres);
    std::optional<Eigen::Isometry3d> motion;
    if (opencv_before) {
      motion = opencv.align(opencv_before, opencv_frame);
      theirs.failures += motion ? 0 : 1;
      theirs.time_ms = std::min(theirs.time_ms, watch.milliseconds());
    }
    theirs.add(frame->time, motion);
    motion.reset();
    if (before) {
      const Stopwatch own_watch;
      const PoseEstimate estimate = estimator->estimate(*before, map, Eigen::Isometry3d::Identity());
      ours.time_ms = std::min(ours.time_ms, own_watch.milliseconds());
      ours.failures += estimate.failed ? 1 : 0;
      if (getenv("DBG")) {
        for (auto& [k, t] : device.take_kernel_times()) fmt::print("{} {:.2f}, ", k, t);
        fmt::print("{} its, {} samples {} landed {} inliers {:.3f} mm cond {:.5f}\n", estimate.iterations,
                   estimate.samples, estimate.landed, estimate.inliers, estimate.mean_error,
                   estimate.conditioning);
      }
      if (!estimate.failed) motion = estimate.target_from_source;
    }
    ours.add(frame->time, motion);
    before.emplace(std::move(map));
    opencv_before = opencv_frame;
  }
  return {{"name", sequence.name},
          {"frames", truth.size()},
          {"ours", ours.row(truth)},
          {"opencv", theirs.row(truth)}};
}

void print(const ordered_json& row) {
  for (const char* who : {"ours", "opencv"}) {
    const auto value = [&](const char* key) { return row[who][key].get<double>(); };
    fmt::print(
        "{:<12} {:>4} frames {:<7} drift {:6.3f} mm {:6.4f} degrees a frame, in the end {:7.2f} mm "
        "{:6.3f} degrees; {:6.2f} ms a frame, {} failures\n",
        row["name"].get<std::string>(), row["frames"].get<int>(), who, value("drift_mm"),
        value("drift_degrees"), value("error_mm"), value("error_degrees"), value("time_ms"),
        row[who]["failures"].get<int>());
  }
}

}  // namespace

int run_pose_mode(const Options& options) {
  Device device;
  if (getenv("DBG")) device.measure_stages(true);
  Registry registry;
  register_everything(registry);
  auto rows = ordered_json::array();
  for (const KnownSequence& sequence : sequences) {
    if (std::string(sequence.name).find(options.only) == std::string::npos) continue;
    if (*sequence.needs != '\0' && !find_data(data_folders(""), sequence.needs)) continue;
    rows.push_back(track(sequence, options.quick ? 60 : 300, registry, device));
    print(rows.back());
  }
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
