#pragma once

#include <functional>

#include "benchmarks/stage_times.h"
#include "framework/device/device.h"

namespace pliant::bench {

/// The stage "icp" from the surface of the first frame to that of the second, as a Preprocessor makes them.
StagePair icp_stage(Device& device, const TrackedImages& images);

/// The whole frame: a Tracker that gets the two frames in turn, images on the host included, on the volume
/// that model_stages has. `opencv`: what is to stand beside it.
StagePair whole_frame(Device& device, const TrackedImages& images, std::function<void()> opencv);

}  // namespace pliant::bench
