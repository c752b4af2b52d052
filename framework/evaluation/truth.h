#pragma once

#include <Eigen/Core>

#include "framework/geometry/frame.h"

namespace pliant {

/// What is known of a pair beyond its images. Nothing that registers sees it: it is what results are measured
/// against.
struct PairTruth {
  /// Motion in mm (camera frame) of the surface point seen at each source pixel; NaN where it is unknown.
  Image<Eigen::Vector3f> scene_flow;
  /// Pixels of the depth camera, from a source pixel to where its surface point is in the target's image; NaN
  /// where it is unknown. Empty where none is known.
  Image<Eigen::Vector2f> optical_flow = {};
  /// Non-zero where the target shows the surface point of the source pixel. Empty where that is not known.
  MaskImage visible = {};
};

/// Throws DataError, which names the pair and both sizes, unless what is known has the size of the pair's
/// images.
void check(const PairTruth& truth, const FramePair& pair);

}  // namespace pliant
