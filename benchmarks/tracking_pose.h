#pragma once

#include "benchmarks/stage_times.h"
#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/projective_icp.h"

namespace pliant::bench {

/// The stage "icp": ours from `source` to `target`, maps on `device` of the two frames of `images`, and
/// OpenCV's as a loop uses it, which makes pyramids of the newer frame and aligns it to the one before. What
/// is referred to must outlive the pair.
StagePair pose_stage(Device& device, const TrackedImages& images, const SurfaceMap& source,
                     const SurfaceMap& target, const ProjectiveIcpOptions& options = {});

}  // namespace pliant::bench
