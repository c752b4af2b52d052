#pragma once

#include <vector>

#include "benchmarks/stage_times.h"
#include "framework/device/device.h"

namespace pliant::bench {

/// `integrate` and `raycast` of a volume of signed distances beside cv::kinfu::Volume (TSDF), on the same
/// grid with the same truncation and greatest weight: 256^3 voxels over 3 m, or, where a region is tracked,
/// fitted to what it shows. The first frame is fused before; then the second one again and again, and the
/// view from there.
std::vector<StagePair> model_stages(Device& device, const TrackedImages& images);

}  // namespace pliant::bench
