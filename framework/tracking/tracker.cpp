#include "framework/tracking/tracker.h"

#include <fmt/format.h>

#include <utility>

#include "framework/core/stopwatch.h"

namespace pliant {
namespace {

/// Of the share of the model's points that are matched, which a leap or a wrong pose makes fall at once: less
/// than so much of what it was in the frame before is no pose.
constexpr double least_of_share = 0.75;

double share_of(const PoseEstimate& pose) {
  return pose.samples > 0 ? static_cast<double>(pose.inliers) / pose.samples : 0;
}

bool shows_depth(const Frame& frame, const PixelWindow& region) {
  for (int v = region.top; v < region.top + region.height; ++v)
    for (int u = region.left; u < region.left + region.width; ++u)
      if (is_depth(frame.depth(u, v)) && (frame.mask.empty() || frame.mask(u, v) != 0)) return true;
  return false;
}

}  // namespace

Tracker::Tracker(const TrackingMethod& method, const Rig& rig, Device& device)
    : method_(method),
      rig_(rig),
      device_(device),
      pose_(method.pose->make(device)),
      meter_(device, method.error),
      moved_view_(rig.depth, {}, {}) {
  check(rig, "the rig");
  relocalizer_ = method.relocalizer->make(device_, rig_);
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
      follow(frame, record);
    else
      begin_model(record);
    if (relocalizer_ && has_pose(record.state)) remember(frame, record);
  }
  device_.finish();
  for (const auto& [stage, time] : device_.take_stage_times()) record.time_ms[stage] += time;
  record.camera_from_model = camera_from_model_;
  record.total_ms = watch.milliseconds();
  return record;
}

/// Whether the frame shows what is to be modelled; its region is the one from now on.
bool Tracker::find_object(const Frame& frame, FrameRecord& record) {
  auto region = find_region(frame, record);
  if (!region) return false;
  region_ = *std::move(region);
  preprocessor_.emplace(device_, rig_, method_.acquisition, region_.window);
  return true;
}

/// Where the segmentation finds the object; else the record says why there is none.
std::optional<Region> Tracker::find_region(const Frame& frame, FrameRecord& record) const {
  Frame cut = frame;
  cut.depth = cut_depth(frame.depth, method_.acquisition.farthest());
  auto region = timed(record.time_ms, "segmentation", [&] { return method_.segmentation->find(cut, rig_); });
  if (region) cut_to(*region, cut);
  if (!region)
    record.reason = "the object is not found";
  else if (!shows_depth(cut, region->window))
    record.reason = "there is no depth";
  return record.reason.empty() ? region : std::nullopt;
}

void Tracker::preprocess(const Frame& frame) {
  preprocessor_->move_to(region_.window);
  if (region_.mask.empty()) return preprocessor_->process(frame);
  Frame cut = frame;
  cut_to(region_, cut);
  preprocessor_->process(cut);
}

void Tracker::begin_model(FrameRecord& record) {
  auto model = method_.update->make(device_, method_.model->make(device_, seen()));
  fuse_into(*model);
  if (!method_.policy || method_.policy->is_rigid()) focal_length_.emplace(device_, seen());
  model_ = std::move(model);
  first_window_ = seen().window;
  record.state = FrameState::started;
}

/// Where the model is now: from where it was, by what of it was seen from there [3.3].
void Tracker::follow(const Frame& frame, FrameRecord& record) {
  record.pose = timed(record.time_ms, "pose",
                      [&] { return pose_->estimate(*model_view_, seen(), Eigen::Isometry3d::Identity()); });
  if (relocalizer_ && !is_sure(record.pose)) relocalise(frame, record);
  record.state = record.pose.failed ? FrameState::lost : FrameState::tracked;
  record.reason = record.pose.reason;
  if (record.pose.failed) return;
  camera_from_model_ = record.pose.target_from_source * camera_from_model_;
  if (focal_length_) focal_length_->add(seen(), camera_from_model_);
  register_model(record);
  fuse_into(*model_);
  if (followed_pixels_.empty() && method_.followed.from > 0 && count_ >= method_.followed.from)
    choose_followed();
}

/// Deforms the model to the frame where the policy takes its error for the sign of a deformation [4.8].
void Tracker::register_model(FrameRecord& record) {
  if (!method_.policy) return;
  moved_view_.camera = model_view_->camera;
  moved_view_.window = model_view_->window;
  if (moved_view_.points().size() != model_view_->points().size())
    moved_view_.map = no_points(device_, model_view_->window.size());
  move_points(device_, model_view_->map, record.pose.target_from_source, moved_view_.map);
  record.rigid_error = record.error = meter_.measure(moved_view_, seen());
  if (!method_.policy->registers({count_, record.rigid_error, rejection_})) return;
  const Stopwatch watch;
  const SurfaceMap& view = model_->view(rig_.depth, seen().window, camera_from_model_);
  camera_from_model_ = ModelRegistration(device_, method_.deformation, method_.error.min_gain)
                           .run(*model_, view, seen(), camera_from_model_, meter_, record);
  rejection_.reset();
  if (is_rejected(record)) rejection_ = {count_, record.rigid_error.mean};
  record.time_ms["registration"] = watch.milliseconds();
}

bool Tracker::is_sure(const PoseEstimate& pose) const {
  return !pose.failed && share_of(pose) >= least_of_share * usual_share_;
}

/// Looks for the model where ICP did not reach [3.3]. What is not found leaves no pose.
void Tracker::relocalise(const Frame& frame, FrameRecord& record) {
  const std::optional<Found> found = search(frame, record);
  record.relocalized = found.has_value();
  if (found) {
    record.pose = found->pose;
    camera_from_model_ = found->start;
    model_view_ = &model_->view(rig_.depth, seen().window, camera_from_model_);
    return;
  }
  model_view_ = &model_->view(rig_.depth, seen().window, camera_from_model_);
  if (record.pose.failed) return;
  record.pose.failed = true;
  record.pose.reason = fmt::format("{:.0f} % of the model's points have a match, expected {:.0f} %",
                                   100 * share_of(record.pose), 100 * least_of_share * usual_share_);
}

/// Wherever the frame shows the object, from the last pose that was found and from those that the relocalizer
/// names: the pose with most matches.
std::optional<Tracker::Found> Tracker::search(const Frame& frame, FrameRecord& record) {
  FrameRecord searched;
  auto region = find_region(frame, searched);
  if (!region) return std::nullopt;
  if (window_ && region->mask.empty()) region->window = window_->move_to(region->window);
  region_ = *std::move(region);
  preprocess(frame);
  auto starts =
      timed(record.time_ms, "relocalisation", [&] { return relocalizer_->candidates(frame, seen()); });
  starts.insert(starts.begin(), camera_from_model_);
  std::optional<Found> best;
  for (const Eigen::Isometry3d& start : starts) {
    const PoseEstimate pose = timed(record.time_ms, "pose", [&] { return estimate_from(start); });
    if (is_sure(pose) && (!best || pose.inliers > best->pose.inliers)) best = Found{start, pose};
  }
  return best;
}

PoseEstimate Tracker::estimate_from(const Eigen::Isometry3d& camera_from_model) {
  const SurfaceMap& view = model_->view(rig_.depth, seen().window, camera_from_model);
  return pose_->estimate(view, seen(), Eigen::Isometry3d::Identity());
}

/// What a later frame may be found by, and where the next one is looked for.
void Tracker::remember(const Frame& frame, FrameRecord& record) {
  const Stopwatch watch;
  relocalizer_->remember(frame, seen(), camera_from_model_);
  record.time_ms["keyframe"] += watch.milliseconds();
  if (record.state == FrameState::tracked) usual_share_ = share_of(record.pose);
  if (!region_.mask.empty()) return;
  if (!window_) {
    const double depth = middle_of(seen()).value_or(Eigen::Vector3d::Zero()).z();
    window_.emplace(rig_.depth, region_.window, depth, camera_from_model_);
  }
  region_.window = window_->move_to(camera_from_model_);
}

/// Fuses the frame as it was seen, unfiltered, into the model, and looks at that from its camera [3.2].
void Tracker::fuse_into(DeformingModel& model) {
  model.integrate(preprocessor_->depth(), rig_.depth, camera_from_model_);
  model_view_ = &model.view(rig_.depth, seen().window, camera_from_model_);
}

/// The model's surface where the frame that began it showed it: there the camera was the model's frame.
void Tracker::choose_followed() {
  const PixelWindow& window = first_window_;
  const SurfaceMap& view = model_->view(rig_.depth, window, Eigen::Isometry3d::Identity());
  std::vector<int> chosen;
  for (const int offset : indices_of_points(device_, view.map)) {
    const Eigen::Vector2i pixel(window.left + offset % window.width, window.top + offset / window.width);
    if (pixel.x() % method_.followed.step != 0 || pixel.y() % method_.followed.step != 0) continue;
    chosen.push_back(offset);
    followed_pixels_.push_back(pixel);
  }
  model_->follow(pick_points(device_, view.map, Array<int>(chosen)).points);
  model_view_ = &model_->view(rig_.depth, seen().window, camera_from_model_);
}

}  // namespace pliant
