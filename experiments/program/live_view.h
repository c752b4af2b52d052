#pragma once

#include <functional>
#include <optional>

#include "experiments/program/window.h"
#include "experiments/view/frame_picture.h"
#include "experiments/view/frame_rate.h"
#include "experiments/view/track_observer.h"

namespace pliant {

/// Shows frames in a window while they are tracked. Who closes it has seen enough; while it is paused,
/// tracking waits.
class LiveView : public TrackObserver {
 public:
  /// `is_ended`: whether someone else has seen enough. Throws as Window does.
  explicit LiveView(std::function<bool()> is_ended) : is_ended_(std::move(is_ended)) {}

  void begin(const Rig& rig) override;
  bool show(const TrackedFrame& tracked) override;
  bool is_closed() const { return window_.is_closed(); }

 private:
  std::function<bool()> is_ended_;
  Window window_{"Pliant: space pauses, q ends"};
  std::optional<FramePicture> picture_;
  FrameRate rate_;
};

}  // namespace pliant
