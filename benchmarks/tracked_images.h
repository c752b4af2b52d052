#pragma once

#include "benchmarks/stage_times.h"
#include "framework/device/device.h"

namespace pliant::bench {

/// A furnished room that fills a full image of 640x480 pixels and ends 3 m before the camera, and a head 700
/// mm before it whose bounding box is the region: about 30,000 points. Both with the noise of the first
/// Kinect, the same every time, and a camera that moves as a hand moves it from one frame to the next.
TrackedImages room_images(Device& device);
TrackedImages head_images(Device& device);

}  // namespace pliant::bench
