#include "framework/tracking/tracker.h"

#include <fmt/format.h>

#include <utility>

#include "framework/core/stopwatch.h"

namespace pliant {
namespace {

bool shows_depth(const Frame& frame, const PixelWindow& region) {
  for (int v = region.top; v < region.top + region.height; ++v)
    for (int u = region.left; u < region.left + region.width; ++u)
      if (is_depth(frame.depth(u, v)) && (frame.mask.empty() || frame.mask(u, v) != 0)) return true;
  return false;
}

}  // namespace

Tracker::Tracker(const TrackingMethod& method, const Rig& rig, Device& device)
    : method_(method), rig_(rig), device_(device), pose_(method.pose->make(device)) {
  check(rig, "the rig");
}

FrameRecord Tracker::track(const Frame& frame) {
  const Stopwatch watch;
  FrameRecord record;
  record.number = ++count_;
  record.time = frame.time;
  check(frame, rig_, fmt::format("frame {}: the", record.number));
  device_.take_stage_times();  // of whatever came before
  if (has_model() || find_object(frame, record)) {
    const Stopwatch upload;
    preprocess(frame);
    record.time_ms["upload"] = upload.milliseconds();
    if (has_model())
      follow(record);
    else
      begin_model(record);
  }
  device_.finish();
  for (const auto& [stage, time] : device_.take_stage_times()) record.time_ms[stage] += time;
  record.camera_from_model = camera_from_model_;
  record.total_ms = watch.milliseconds();
  return record;
}

/// Whether the frame shows what is to be modelled; its region is the one from now on.
bool Tracker::find_object(const Frame& frame, FrameRecord& record) {
  Frame cut = frame;
  cut.depth = cut_depth(frame.depth, method_.acquisition.farthest());
  auto region = timed(record.time_ms, "segmentation", [&] { return method_.segmentation->find(cut, rig_); });
  if (region) cut_to(*region, cut);
  if (!region) {
    record.reason = "the object is not found";
  } else if (!shows_depth(cut, region->window)) {
    record.reason = "there is no depth";
  } else {
    region_ = *std::move(region);
    preprocessor_.emplace(device_, rig_, method_.acquisition, region_.window);
    meter_.emplace(device_, method_.error, region_.window.size());
    moved_view_ = no_points(device_, region_.window.size());
  }
  return record.reason.empty();
}

void Tracker::preprocess(const Frame& frame) {
  if (region_.mask.empty()) return preprocessor_->process(frame);
  Frame cut = frame;
  cut_to(region_, cut);
  preprocessor_->process(cut);
}

void Tracker::begin_model(FrameRecord& record) {
  auto model = method_.update->make(device_, method_.model->make(device_, seen()));
  fuse_into(*model);
  model_ = std::move(model);
  record.state = FrameState::started;
}

/// Where the model is now: from where it was, by what of it was seen from there [3.3].
void Tracker::follow(FrameRecord& record) {
  record.pose = timed(record.time_ms, "pose",
                      [&] { return pose_->estimate(*model_view_, seen(), Eigen::Isometry3d::Identity()); });
  record.state = record.pose.failed ? FrameState::lost : FrameState::tracked;
  record.reason = record.pose.reason;
  if (record.pose.failed) return;
  camera_from_model_ = record.pose.target_from_source * camera_from_model_;
  register_model(record);
  fuse_into(*model_);
  if (followed_pixels_.empty() && method_.followed.from > 0 && count_ >= method_.followed.from)
    choose_followed();
}

/// Deforms the model to the frame where the policy takes its error for the sign of a deformation [4.8].
void Tracker::register_model(FrameRecord& record) {
  if (!method_.policy) return;
  move_points(device_, model_view_->map, record.pose.target_from_source, moved_view_);
  record.rigid_error = record.error = meter_->measure(moved_view_, seen());
  if (!method_.policy->registers(record.rigid_error, count_)) return;
  const Stopwatch watch;
  const SurfaceMap& view = model_->view(rig_.depth, seen().window, camera_from_model_);
  camera_from_model_ = ModelRegistration(device_, method_.deformation, method_.error.min_gain)
                           .run(*model_, view, seen(), camera_from_model_, *meter_, record);
  record.time_ms["registration"] = watch.milliseconds();
}

/// Fuses the frame as it was seen, unfiltered, into the model, and looks at that from its camera [3.2].
void Tracker::fuse_into(DeformingModel& model) {
  model.integrate(preprocessor_->depth(), rig_.depth, camera_from_model_);
  model_view_ = &model.view(rig_.depth, seen().window, camera_from_model_);
}

/// The model's surface where the frame that began it showed it: there the camera was the model's frame.
void Tracker::choose_followed() {
  const PixelWindow window = seen().window;
  const SurfaceMap& view = model_->view(rig_.depth, window, Eigen::Isometry3d::Identity());
  std::vector<int> chosen;
  for (const int offset : indices_of_points(device_, view.map)) {
    const Eigen::Vector2i pixel(window.left + offset % window.width, window.top + offset / window.width);
    if (pixel.x() % method_.followed.step != 0 || pixel.y() % method_.followed.step != 0) continue;
    chosen.push_back(offset);
    followed_pixels_.push_back(pixel);
  }
  model_->follow(pick_points(device_, view.map, Array<int>(chosen)).points);
  model_view_ = &model_->view(rig_.depth, window, camera_from_model_);
}

}  // namespace pliant
