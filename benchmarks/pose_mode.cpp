#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/bench.h"
#include "benchmarks/opencv_icp.h"
#include "experiments/datasets/frame_source.h"
#include "experiments/program/folders.h"
#include "experiments/runner/components.h"
#include "framework/config/config.h"
#include "framework/core/stopwatch.h"
#include "framework/evaluation/trajectory_error.h"
#include "framework/imaging/bilateral.h"
#include "framework/imaging/depth_map.h"
#include "framework/io/text_lines.h"
#include "framework/model/reference_model.h"
#include "framework/pose/pose_estimator.h"

namespace pliant::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// A sequence whose camera poses are known.
struct KnownSequence {
  const char* name;  ///< of its file in experiments/tracking
  const char*
      poses;  ///< their file in a data folder that not every machine has; empty: the stream knows them
};

constexpr std::array sequences{
    KnownSequence{"head", ""},
    KnownSequence{"sheet", ""},
    KnownSequence{"room", ""},
    KnownSequence{"livingroom", "icl_livingroom60/poses.txt"},
};

Parameters read_experiment(const std::string& name, const Registry& registry) {
  const fs::path file = fs::path(PLIANT_SOURCE_FOLDER) / "experiments" / "tracking" / (name + ".yaml");
  return load_experiment({file, {}, data_folders("")},
                         {component("data", FrameSource::kind), component("model", ModelKind::kind, "tsdf"),
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
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        pose.matrix()(row, column) = lines.real(*line, static_cast<std::size_t>(1 + 4 * row + column));
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

  /// None: as far as is known it has not moved.
  void add(double time, const std::optional<Eigen::Isometry3d>& target_from_source) {
    Eigen::Isometry3d pose = trajectory.empty() ? Eigen::Isometry3d::Identity() : trajectory.back().pose;
    if (target_from_source) pose = pose * target_from_source->inverse();
    trajectory.push_back({time, pose});
  }

  void add(double time, const PoseEstimate& estimate) {
    failures += estimate.failed ? 1 : 0;
    add(time, estimate.target_from_source);
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

template <class Work>
auto timed(double& least_ms, Work work) {
  const Stopwatch watch;
  auto result = work();
  least_ms = std::min(least_ms, watch.milliseconds());
  return result;
}

/// Tracks each frame against the one before.
class FrameTracker {
 public:
  explicit FrameTracker(std::unique_ptr<PoseEstimator> estimator) : estimator_(std::move(estimator)) {}

  void track(double time, SurfaceMap map) {
    if (before_)
      chain.add(time, timed(chain.time_ms, [&] { return estimator_->estimate(*before_, map, still_); }));
    else
      chain.add(time, std::nullopt);
    before_.emplace(std::move(map));
  }

  Chain chain;

 private:
  const Eigen::Isometry3d still_ = Eigen::Isometry3d::Identity();
  std::unique_ptr<PoseEstimator> estimator_;
  std::optional<SurfaceMap> before_;
};

/// Tracks each frame against a model that the frames are fused into.
class ModelTracker {
 public:
  ModelTracker(Device& device, std::unique_ptr<PoseEstimator> estimator, std::unique_ptr<ModelKind> kind)
      : device_(device), estimator_(std::move(estimator)), kind_(std::move(kind)) {}

  void track(double time, const DepthMap& depth, const SurfaceMap& map) {
    const Camera& camera = map.camera;
    if (model_) {
      const SurfaceMap& seen = model_->raycast(camera, whole_image(camera), camera_from_model());
      device_.finish();
      const PoseEstimate estimate =
          timed(chain.time_ms, [&] { return estimator_->estimate(seen, map, still_); });
      chain.add(time, estimate);
      if (estimate.failed) return;
    } else {
      model_ = kind_->make(device_, map);
      chain.add(time, std::nullopt);
    }
    model_->integrate(depth, camera, camera_from_model());
  }

  Chain chain;

 private:
  Eigen::Isometry3d camera_from_model() const { return chain.trajectory.back().pose.inverse(); }

  const Eigen::Isometry3d still_ = Eigen::Isometry3d::Identity();
  Device& device_;
  std::unique_ptr<PoseEstimator> estimator_;
  std::unique_ptr<ModelKind> kind_;
  std::unique_ptr<ReferenceModel> model_;
};

/// OpenCV's, each frame against the one before, as its samples use it.
class OpencvTracker {
 public:
  explicit OpencvTracker(const Camera& camera) : icp_(camera) {}

  void track(double time, const DepthImage& depth) {
    const cv::Mat in_metres = OpencvIcp::depth_of(depth);
    const Stopwatch watch;
    OpencvIcp::Frame frame = icp_.prepare(in_metres);
    std::optional<Eigen::Isometry3d> motion;
    if (before_) {
      motion = icp_.align(before_, frame);
      chain.failures += motion ? 0 : 1;
      chain.time_ms = std::min(chain.time_ms, watch.milliseconds());
    }
    chain.add(time, motion);
    before_ = frame;
  }

  Chain chain;

 private:
  OpencvIcp icp_;
  OpencvIcp::Frame before_;
};

/// Points as they were seen, normals of the filtered depth: a filter that flattens what bends would draw
/// every frame a little to the same side.
SurfaceMap map_of(const DepthMap& depth, const Camera& camera, Device& device) {
  const BilateralFilter filter(4.5, 30, 6);
  SurfaceMap map = make_surface_map(device, *filter.filter(device, depth, camera), camera);
  map.map.points = std::move(make_surface_map(device, depth, camera).map.points);
  return map;
}

ordered_json track(const KnownSequence& sequence, int most_frames, const Registry& registry, Device& device) {
  const Parameters experiment = read_experiment(sequence.name, registry);
  const auto stream = registry.make<FrameSource>(experiment.section("data"))->open(device, 1);
  const auto estimator = registry.make<PoseEstimatorKind>(experiment.section("pose"));
  std::vector<Eigen::Isometry3d> known;
  if (*sequence.poses != '\0')
    known = read_matrices((*find_data(data_folders(""), sequence.poses) / sequence.poses).string());
  const Camera& camera = stream->rig().depth;
  FrameTracker frames(estimator->make(device));
  ModelTracker model(device, estimator->make(device), registry.make<ModelKind>(experiment.section("model")));
  OpencvTracker opencv(camera);
  Trajectory truth;
  CheckedStream checked(*stream);
  while (const auto frame = checked.next()) {
    const int number = static_cast<int>(truth.size()) + 1;
    if (number > most_frames) break;
    truth.push_back({frame->time, known.empty() ? *stream->camera_pose(number)
                                                : known.at(static_cast<std::size_t>(number - 1))});
    const DepthMap depth(*frame);
    SurfaceMap map = map_of(depth, camera, device);
    device.finish();
    model.track(frame->time, depth, map);
    frames.track(frame->time, std::move(map));
    opencv.track(frame->time, frame->depth);
  }
  return {{"name", sequence.name},
          {"frames", truth.size()},
          {"frame_to_model", model.chain.row(truth)},
          {"frame_to_frame", frames.chain.row(truth)},
          {"opencv", opencv.chain.row(truth)}};
}

void print(const ordered_json& row) {
  for (const char* who : {"frame_to_model", "frame_to_frame", "opencv"}) {
    const auto value = [&](const char* key) { return row[who][key].get<double>(); };
    fmt::print(
        "{:<10} {:>3} frames {:<14} drift {:6.3f} mm {:6.4f} degrees a frame, error {:7.2f} mm {:6.3f} "
        "degrees; {:6.2f} ms at least, {} failures\n",
        row["name"].get<std::string>(), row["frames"].get<int>(), who, value("drift_mm"),
        value("drift_degrees"), value("error_mm"), value("error_degrees"), value("time_ms"),
        row[who]["failures"].get<int>());
  }
}

}  // namespace

int run_pose_mode(const Options& options) {
  Device device;
  Registry registry;
  register_everything(registry);
  auto rows = ordered_json::array();
  for (const KnownSequence& sequence : sequences) {
    if (std::string(sequence.name).find(options.only) == std::string::npos) continue;
    if (*sequence.poses != '\0' && !find_data(data_folders(""), sequence.poses)) continue;
    rows.push_back(track(sequence, options.quick ? 60 : 300, registry, device));
    print(rows.back());
  }
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
