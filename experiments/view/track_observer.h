#pragma once

#include "experiments/view/tracked_frame.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// Watches frames that are tracked.
class TrackObserver {
 public:
  virtual ~TrackObserver() = default;
  /// Called once for a stream, before its first frame.
  virtual void begin(const Rig& rig) = 0;
  /// Called for every frame, in their order; gives whether to go on.
  virtual bool show(const TrackedFrame& tracked) = 0;
};

}  // namespace pliant
