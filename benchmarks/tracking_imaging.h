#pragma once

#include <vector>

#include "benchmarks/stage_times.h"
#include "framework/device/device.h"

namespace pliant::bench {

/// `bilateral`: 13x13 pixels, 4.5 pixels and 30 mm, beside cv::bilateralFilter; `normals`: points and normals
/// of the filtered depth, beside the normals alone of cv::rgbd::RgbdNormals (FALS, its default window), which
/// is given the points. Both over the region of the images.
std::vector<StagePair> imaging_stages(Device& device, const TrackedImages& images);

}  // namespace pliant::bench
