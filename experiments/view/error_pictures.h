#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "experiments/view/moment.h"
#include "experiments/view/track_observer.h"

namespace pliant {

/// Chosen frames of a stream side by side, as PictureStrip shows some, on a scale that does not depend on the
/// stream: pictures of several runs can be compared.
class ErrorPictures : public TrackObserver {
 public:
  /// `frames`: by their numbers, the first is 1; `highest`: mm, what the colours of errors end at.
  ErrorPictures(std::set<int> frames, float highest)
      : missing_(std::move(frames)), scale_{ColorScale::Map::error, 0, highest} {}

  void begin(const Rig&) override {}
  bool show(const TrackedFrame& tracked) override {
    if (tracked.model != nullptr && missing_.erase(tracked.record.number) > 0)
      moments_.push_back(moment_of(tracked));
    return true;
  }

  /// Whether there is anything to show: none of the frames has come, or there was no model yet.
  bool empty() const { return moments_.empty(); }
  /// The frames that have not come, or came before there was a model.
  const std::set<int>& missing() const { return missing_; }
  std::vector<std::uint8_t> png() const { return draw_moments(moments_, scale_, 2); }

 private:
  std::set<int> missing_;
  ColorScale scale_;
  std::vector<Moment> moments_;
};

}  // namespace pliant
