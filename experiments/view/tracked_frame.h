#pragma once

#include "framework/geometry/frame.h"
#include "framework/geometry/surface_map.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// What there is to see of a frame when it has been tracked; valid until the next one is.
struct TrackedFrame {
  const Frame& frame;
  const ColorImage& color;  ///< of the frame, with virtual objects where there are some; may be empty
  const FrameRecord& record;
  const SurfaceMap* seen;   ///< the surface of the frame, in its camera's frame; null: there is no model yet
  const SurfaceMap* model;  ///< what that camera sees of the model at the last pose that was found; as `seen`
};

}  // namespace pliant
