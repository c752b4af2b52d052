#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/core/registry.h"
#include "framework/pose/alignment.h"
#include "framework/pose/rigid_ransac.h"

namespace pliant {

/// "7 of 12 feature matches agree on a rigid motion"
std::string agreement(int inliers, int matches);

/// The matches that a deformation may have made: after `motion` they lie nearer than `max_deformation` (mm),
/// and at least half of the six matches nearest to each keep their distance to it to within a quarter (plus 5
/// mm), because a surface bends far more easily than it stretches.
PointMatches keep_deformable(const PointMatches& matches, const Eigen::Isometry3d& motion,
                             double max_deformation);

struct FeatureOptions {
  double scale = 1;     ///< of the images in which features are looked for
  double ratio = 0.85;  ///< nearest over second nearest descriptor distance, at most
  int min_inliers = 8;
  double max_deformation = 120;  ///< mm; a match further from the rigid motion is no feature of the surface
  RansacOptions ransac;
};

/// Matches of colour features [SIFT, ratio test of Lowe 2004] that have depth and lie inside the masks.
/// Throws DataError without colour or with fewer than two features in either frame.
/// Depth is that of a plane through 5 x 5 pixels. Where the source covers fewer than 6000 pixels at
/// `least_scale`, images are shrunk less, at most not at all.
PointMatches match_features(const FramePair& pair, double ratio, double least_scale = 1);

/// How a match counts whose greater feature has this radius on the surface (mm): what is found in a coarse
/// level of the scale space is as many times less precise, and a squared residual weighs 1 / variance.
/// Features below 5 mm count as 1: there depth is what limits them.
double feature_confidence(double radius);

/// Rigid motion by colour features, and the matches that go with it.
/// Throws as match_features does.
AlignmentResult align_by_features(const FramePair& pair, const FeatureOptions& options, std::uint64_t seed);

/// The rows of `FeatureOptions` in an experiment file, and what they say.
std::vector<Parameter> feature_rows();
FeatureOptions read_feature_options(const Parameters& section);

/// Adds the alignment `features`.
void register_feature_alignment(Registry& registry);

}  // namespace pliant
