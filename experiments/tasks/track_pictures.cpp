#include "experiments/tasks/track_pictures.h"

#include <utility>

namespace pliant {

ParameterTable record_table() {
  return {
      boolean("video", false).doc("writes video.avi: pictures of the frames that are tracked"),
      integer("every", 1).range(1, 10000).doc("so many frames go by from one of its pictures to the next"),
  };
}

TrackPictures::TrackPictures(const ExperimentRun& run, const Making& making, const Rig& rig, Device& device)
    : video_file_(making.folder / video_name), observers_{strip_.get(), view_.get()} {
  if (making.observer != nullptr) observers_.push_back(making.observer);
  if (run.values.has("record")) {
    const Parameters& record = run.values.section("record");
    if (record.boolean("video"))
      observers_.push_back(&video_.emplace(video_file_, static_cast<int>(record.integer("every"))));
  }
  const bool is_color_seen = video_ || making.observer != nullptr;
  if (is_color_seen && run.values.has("augmentation"))
    augmentation_.emplace(make_augmentation(run.values.section("augmentation"), device, rig));
  for (TrackObserver* observer : observers_) observer->begin(rig);
}

bool TrackPictures::show(const Frame& frame, const FrameRecord& record, const Tracker& tracker) {
  const bool has_model = tracker.has_model();
  ColorImage augmented;
  if (augmentation_ && has_pose(record.state))
    augmented = augmentation_->draw(frame, record.camera_from_model);
  const TrackedFrame tracked{frame, augmented.empty() ? frame.color : augmented, record,
                             has_model ? &tracker.seen() : nullptr,
                             has_model ? &tracker.model_view() : nullptr};
  bool goes_on = true;
  for (TrackObserver* observer : observers_) goes_on &= observer->show(tracked);
  return goes_on;
}

void TrackPictures::add_to(RunArtefacts& made, Mesh model) const {
  if (video_) made.files.push_back(video_file_);
  if (strip_->empty()) return;
  const Picture strip(strip_name, "The model and how far the frames are from it",
                      [strip = strip_] { return strip->png(); });
  made.pictures.push_back(strip);
  made.view.emplace(
      [view = view_, strip, model = std::move(model)] { return view->view(model, strip.png()); });
}

}  // namespace pliant
