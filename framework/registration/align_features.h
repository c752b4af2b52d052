#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "framework/core/registry.h"
#include "framework/registration/alignment.h"

namespace pliant {

/// Points of the source (`from`) and of the target (`to`) that are believed to be the same, in mm.
struct PointMatches {
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;

  std::size_t size() const { return from.size(); }
};

struct RansacOptions {
  int iterations = 10000;
  double inlier_distance = 30;  ///< mm
};

/// The rigid motion that most matches agree with, fitted to all of those. Fewer than three matches, or
/// none that span a triangle, give the identity without inliers.
/// The same seed gives the same bits with any standard library.
AlignmentResult fit_rigid_ransac(const PointMatches& matches, const RansacOptions& options,
                                 std::uint64_t seed);

struct FeatureOptions {
  double ratio = 0.85;  ///< nearest over second nearest descriptor distance, at most
  int min_inliers = 8;
  RansacOptions ransac;
};

/// Matches of colour features [SIFT, ratio test of Lowe 2004] that have depth and lie inside the masks.
/// Throws DataError without colour or with fewer than two features in either frame.
PointMatches match_features(const FramePair& pair, double ratio);

/// Adds the alignment `features`.
void register_feature_alignment(Registry& registry);

}  // namespace pliant
