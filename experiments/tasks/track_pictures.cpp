#include "experiments/tasks/track_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <set>
#include <string>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/point_set.h"

namespace pliant {

ParameterTable record_table() {
  return {
      boolean("video", false).doc("writes video.avi: pictures of the frames that are tracked"),
      words("error_at")
          .optional()
          .doc("numbers of frames, the first is 1, that errors.png shows: the model and how far the frame is "
               "from it"),
      real("error_scale", 10).unit("mm").range(0.01, 1000).doc("what the colours of errors.png end at"),
      integer("until", 0).range(0, 1e9).doc("number of the frame that tracking ends with; 0: the last one"),
      integer("every", 1).range(1, 10000).doc("so many frames go by from one of its pictures to the next"),
      choice("tracks", {"none", "gltf", "ply", "both"}, "none")
          .doc("writes where the points of `followed` went: tracks.glb, an animated mesh for any viewer, "
               "tracks/frame_0123.ply, a mesh a frame, or both"),
      integer("tracks_every", 1)
          .range(1, 10000)
          .doc("so many frames go by from one frame of `tracks` to the next"),
  };
}

namespace {

constexpr std::size_t most_frames = 24;

std::set<int> frames_of(const Parameters& record) {
  std::set<int> frames;
  for (const std::string& word : record.words("error_at")) {
    int number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || number < 1)
      throw ConfigError(fmt::format("{}: '{}' in 'error_at' is no frame; expected whole numbers from 1 on",
                                    record.place(), word));
    frames.insert(number);
  }
  if (frames.size() > most_frames)
    throw ConfigError(fmt::format("{}: 'error_at' has {} frames; expected at most {}", record.place(),
                                  frames.size(), most_frames));
  return frames;
}

}  // namespace

std::shared_ptr<ErrorPictures> make_error_pictures(const Parameters& record) {
  std::set<int> frames = frames_of(record);
  if (frames.empty()) return nullptr;
  return std::make_shared<ErrorPictures>(std::move(frames), static_cast<float>(record.real("error_scale")));
}

TrackPictures::TrackPictures(const ExperimentRun& run, const Making& making, const Rig& rig, Device& device)
    : tracks_(make_point_tracks(run.values, making.folder, rig)),
      video_file_(making.folder / video_name),
      observers_{strip_.get(), view_.get()} {
  if (making.observer != nullptr) observers_.push_back(making.observer);
  if (run.values.has("record")) {
    const Parameters& record = run.values.section("record");
    last_frame_ = static_cast<int>(record.integer("until"));
    if ((errors_ = make_error_pictures(record))) observers_.push_back(errors_.get());
    if (record.boolean("video"))
      observers_.push_back(&video_.emplace(video_file_, static_cast<int>(record.integer("every"))));
  }
  const bool is_color_seen = video_ || making.observer != nullptr;
  if (is_color_seen && run.values.has("augmentation")) {
    const Parameters& section = run.values.section("augmentation");
    augmentation_.emplace(make_augmentation(section, device, rig));
    reach_ = section.real("reach");
  }
  for (TrackObserver* observer : observers_) observer->begin(rig);
}

bool TrackPictures::show(const Frame& frame, const FrameRecord& record, const Tracker& tracker) {
  const bool has_model = tracker.has_model();
  if (tracks_ && has_pose(record.state) && !tracker.followed_pixels().empty())
    tracks_->add(record.number, record.time, tracker.followed_pixels(),
                 unflatten(tracker.model().followed()));
  ColorImage augmented;
  if (augmentation_ && has_pose(record.state))
    augmented = augmentation_->draw(frame, camera_from_surface(record, tracker));
  const TrackedFrame tracked{frame, augmented.empty() ? frame.color : augmented, record,
                             has_model ? &tracker.seen() : nullptr,
                             has_model ? &tracker.model_view() : nullptr};
  bool goes_on = record.number != last_frame_;
  for (TrackObserver* observer : observers_) goes_on &= observer->show(tracked);
  return goes_on;
}

/// Where the part of the model that carries the virtual object is: it goes with what is followed of it.
Eigen::Isometry3d TrackPictures::camera_from_surface(const FrameRecord& record, const Tracker& tracker) {
  if (tracker.followed_pixels().empty()) return record.camera_from_model;
  const std::vector<Eigen::Vector3f> points = unflatten(tracker.model().followed());
  if (!attachment_) attachment_.emplace(points, augmentation_->anchor(), reach_);
  return record.camera_from_model * attachment_->motion(points);
}

void TrackPictures::add_to(RunArtefacts& made, Mesh model) const {
  if (tracks_) {
    const auto files = tracks_->finish();
    made.files.insert(made.files.end(), files.begin(), files.end());
    if (files.empty())
      made.notes.emplace_back(
          "no tracks are written: no frame was tracked from which points are followed, or no point of their "
          "grid is on the model");
  }
  if (video_) made.files.push_back(video_file_);
  if (errors_ && !errors_->missing().empty())
    made.notes.push_back(fmt::format("{}.png does not show frame {}: it did not come, or there was no model",
                                     errors_name, fmt::join(errors_->missing(), ", ")));
  if (errors_ && !errors_->empty())
    made.pictures.emplace_back(errors_name, "The model and how far chosen frames are from it",
                               [errors = errors_] { return errors->png(); });
  if (strip_->empty()) return;
  const Picture strip(strip_name, "The model and how far the frames are from it",
                      [strip = strip_] { return strip->png(); });
  made.pictures.push_back(strip);
  made.view.emplace(
      [view = view_, strip, model = std::move(model)] { return view->view(model, strip.png()); });
}

}  // namespace pliant
