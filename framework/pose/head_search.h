#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"
#include "framework/pose/head_forest.h"

namespace pliant {

/// Which patches are asked, and which answers count.
struct HeadSearchOptions {
  int stride = 4;               ///< pixels from one patch to the next
  double least_share = 0.7;     ///< of a leaf's patches that were on a head, for it to vote
  double greatest_spread = 45;  ///< mm of the centre, for a leaf to vote
  double least_confidence = 0.55;
};

/// A head in a depth map.
struct HeadEstimate {
  Eigen::Isometry3d camera_from_head =
      Eigen::Isometry3d::Identity();  ///< mm; the head's frame and centre are those of HeadForest
  /// The votes that agree, as a share of those that a whole head at its distance could cast, times how sure
  /// the trees are that have seen it whole; 0 to 1.
  double confidence = 0;
};

/// The rotation that is nearest to a sum of some.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& sum);

/// The points (mm, camera frame) that may belong to a head with this centre; where more of it is seen than is
/// needed, not all.
std::vector<Eigen::Vector3f> points_near(const DepthImage& depth, const Camera& camera,
                                         const Eigen::Vector3d& centre);

/// Finds the head of which a depth map (mm) shows the most, where it shows one: patches on a grid vote for
/// its centre, mean shift [Comaniciu, Meer 2002] finds where most agree, and the pose that they give is
/// refined. The same input gives the same bits.
std::optional<HeadEstimate> find_head(const HeadForest& forest, const DepthImage& depth, const Camera& camera,
                                      const HeadSearchOptions& options);

}  // namespace pliant
