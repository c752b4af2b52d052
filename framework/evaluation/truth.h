#pragma once

#include <Eigen/Core>

#include "framework/geometry/frame.h"

namespace pliant {

/// What is known of a pair beyond its images. Nothing that registers sees it: it is what results are measured
/// against.
struct PairTruth {
  /// Motion in mm (camera frame) of the surface point seen at each source pixel; NaN where it is unknown.
  Image<Eigen::Vector3f> scene_flow;
};

/// Throws DataError, which names the pair and both sizes, unless the truth has the size of the pair's images.
void check(const PairTruth& truth, const FramePair& pair);

}  // namespace pliant
