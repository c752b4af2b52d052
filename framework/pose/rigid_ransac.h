#pragma once

#include <cstdint>

#include "framework/pose/alignment.h"

namespace pliant {

struct RansacOptions {
  int iterations = 10000;
  double inlier_distance = 30;  ///< mm
};

/// The rigid motion that most matches agree with, fitted to all of those. Fewer than three matches, or
/// none that span a triangle, give the identity without inliers.
/// The same seed gives the same bits with any standard library.
AlignmentResult fit_rigid_ransac(const PointMatches& matches, const RansacOptions& options,
                                 std::uint64_t seed);

}  // namespace pliant
