#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "experiments/tasks/point_truth.h"
#include "experiments/tasks/task.h"
#include "experiments/tasks/track_artefacts.h"
#include "experiments/tasks/track_log.h"
#include "experiments/tasks/track_pictures.h"
#include "experiments/tasks/track_truth.h"
#include "experiments/view/augmentation_section.h"
#include "framework/geometry/prefetched_stream.h"
#include "framework/io/mesh_writer.h"
#include "framework/tracking/tracker.h"

namespace pliant {
namespace {

/// Tells of a frame: how far the stream has come is not known.
void tell(const ProgressSink& progress, const FrameRecord& record) {
  progress({"", 0,
            fmt::format("frame {}: {}, {:.1f} ms", record.number, to_string(record.state), record.total_ms)});
}

void check_repeats(const ExperimentRun& run, int repeats) {
  if (repeats > 0 || run.values.integer("repeat") > 0)
    throw ConfigError(run.place + ": a stream is tracked once; expected no 'repeat'");
}

/// A device tells the times of its stages while one lives.
struct Measuring {
  explicit Measuring(Device& measured) : device(measured) { device.measure_stages(true); }
  ~Measuring() { device.measure_stages(false); }
  Measuring(const Measuring&) = delete;
  Measuring& operator=(const Measuring&) = delete;
  Device& device;
};

/// The errors of the points that a tracker follows, once it does.
class FollowedTruth {
 public:
  explicit FollowedTruth(const DataStream& stream) : stream_(stream) {}

  std::optional<FollowedErrors> error_of(const Tracker& tracker, const FrameRecord& record) {
    if (record.state == FrameState::started) first_ = record.number;
    if (!has_pose(record.state) || tracker.followed_pixels().empty()) return {};
    if (!truth_) truth_.emplace(stream_, first_, tracker.followed_pixels());
    return truth_->error_of(unflatten(tracker.model().followed()), record.camera_from_model, record.number);
  }

 private:
  const DataStream& stream_;
  int first_ = 0;
  std::optional<PointTruth> truth_;
};

std::string focal_length_warning(const FocalLengthEstimate& estimate) {
  return fmt::format(
      "{} views fit together best with a focal length that is {:.0f} % {} (give or take {:.0f} %): the "
      "intrinsics are wrong, or what was tracked is not rigid; calibrate the camera",
      estimate.views, 100 * std::abs(estimate.change), estimate.change > 0 ? "greater" : "smaller",
      100 * estimate.error);
}

class TrackTask : public Task {
 public:
  bool can_end_early() const override { return true; }

  ArtefactNames names() const override {
    ArtefactNames names;
    names.pictures = {TrackPictures::strip_name, TrackPictures::errors_name};
    names.view = true;
    names.files = TrackLog::files();
    names.files.insert(names.files.end(),
                       {model_ply, model_glb, TrackPictures::video_name, PointTracks::gltf_name});
    return names;
  }

  std::vector<std::string> check(const ExperimentRun& run, Workbench& workbench) const override {
    check_repeats(run, 0);
    const TrackingMethod method = make_tracking_method(run.values, workbench.registry());
    const auto stream = workbench.open(run.values);
    const Tracker tracker(method, stream->rig(), workbench.device(run.values));
    if (run.values.has("record")) make_error_pictures(run.values.section("record"));
    make_point_tracks(run.values, {}, stream->rig());
    if (run.values.has("augmentation")) read_object(run.values.section("augmentation"));
    CheckedStream(*stream).next();
    return stream->warnings();
  }

  RunArtefacts make(const ExperimentRun& run, Workbench& workbench, const Making& making) const override {
    check_repeats(run, making.repeats);
    return told_with_place(run.place, [&] {
      Device& device = workbench.device(run.values);
      const TrackingMethod method = make_tracking_method(run.values, workbench.registry());
      const auto stream = workbench.open(run.values);
      Tracker tracker(method, stream->rig(), device);
      TrackSummary summary;
      TrackTruth truth(*stream);
      TrackPictures pictures(run, making, stream->rig(), device);
      const Measuring measuring(device);
      TrackEnd end = track_all(*stream, tracker, making, truth, pictures, summary);
      end.is_ended = making.is_ended();
      if (summary.frames.empty()) throw DataError("it was ended before its first frame");
      std::vector<std::filesystem::path> files;
      for (const auto& name : TrackLog::files()) files.push_back(making.folder / name);
      Mesh model;
      if (tracker.has_model()) {
        model = tracker.model().mesh();
        end.model_error = truth.error_of(model, static_cast<int>(summary.frames.size()));
        end.focal_length = tracker.focal_length();
        if (end.focal_length.is_wrong()) end.warnings.push_back(focal_length_warning(end.focal_length));
        write_model(model, making.folder, files);
      }
      RunArtefacts made = track_artefacts(run, summary, end);
      made.files = std::move(files);
      made.has_ended_early = end.is_ended || !end.error.empty();
      pictures.add_to(made, std::move(model));
      return made;
    });
  }

 private:
  static constexpr const char* model_ply = "model.ply";
  static constexpr const char* model_glb = "model.glb";

  /// Until the stream ends, breaks after its first frame, or is to be ended.
  static TrackEnd track_all(DataStream& stream, Tracker& tracker, const Making& making, TrackTruth& truth,
                            TrackPictures& pictures, TrackSummary& summary) {
    PrefetchedStream ahead(stream);
    CheckedStream frames(ahead);
    FollowedTruth points(stream);
    std::optional<TrackLog> log;
    try {
      while (!making.is_ended()) {
        const auto frame = frames.next();
        if (!frame) break;
        const FrameRecord record = tracker.track(*frame);
        if (!log) log.emplace(making.folder);
        const auto error = truth.error_of(record);
        const auto point_errors = points.error_of(tracker, record);
        log->add(record, error, point_errors);
        making.keep();
        summary.add(record, error, point_errors);
        tell(making.progress, record);
        if (!pictures.show(*frame, record, tracker)) break;
      }
    } catch (const DataError& error) {
      if (summary.frames.empty()) throw;
      return {ahead.warnings(), error.what()};
    }
    return {ahead.warnings()};
  }

  static void write_model(const Mesh& mesh, const std::filesystem::path& folder,
                          std::vector<std::filesystem::path>& files) {
    files.push_back(folder / model_ply);
    write_mesh_ply(files.back().string(), mesh);
    files.push_back(folder / model_glb);
    write_glb(files.back().string(), mesh);
  }
};

}  // namespace

std::unique_ptr<Task> make_track_task() { return std::make_unique<TrackTask>(); }

}  // namespace pliant
