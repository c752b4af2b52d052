#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>

#include "framework/core/registry.h"
#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// What the rigid tracking of a frame came to.
struct PoseEstimate {
  /// mm; the start where it failed.
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  // Of the last matching, before the step that it led to:
  int samples = 0;        ///< points of the source
  int landed = 0;         ///< of them, how many meet a point of the target
  int inliers = 0;        ///< of these, how many are an accepted match
  double mean_error = 0;  ///< mm, root mean square distance of the inliers to the planes of their matches
  /// Least eigenvalue over the greatest of the normal equations, turns measured in mm at the source's extent:
  /// near 0 where the surface may slide or turn along itself.
  double conditioning = 0;
  int weak_directions = 0;  ///< of 6, how many the surface does not tell: there the motion stays at the start
  int iterations = 0;
  bool failed = false;
  std::string reason;  ///< why it failed; else empty
};

/// Finds how the reference model, as it was seen last, moved to the current frame [thesis 3.3]. Bound to one
/// device; keeps its buffers between calls.
class PoseEstimator {
 public:
  virtual ~PoseEstimator() = default;
  /// `source`: the model raycast from the last pose; `target`: the current frame; `start`: the motion to
  /// begin with. What is not finite counts as no point. Waits for the device once. The same input gives the
  /// same bits.
  virtual PoseEstimate estimate(const SurfaceMap& source, const SurfaceMap& target,
                                const Eigen::Isometry3d& start) = 0;
};

/// Makes the pose estimator of an experiment.
class PoseEstimatorKind {
 public:
  static constexpr const char* kind = "pose";
  virtual ~PoseEstimatorKind() = default;
  virtual std::unique_ptr<PoseEstimator> make(Device& device) const = 0;
};

/// Adds `icp_projective`.
void register_pose_estimators(Registry& registry);

}  // namespace pliant
