#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/device/array.h"
#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/pose_estimator.h"
#include "framework/pose/rigid_step.h"

namespace pliant {

struct ProjectiveIcpOptions {
  double max_distance = 10;    ///< mm; matches further apart are rejected
  double max_angle = 0.34907;  ///< radians (20 degrees); matches whose normals differ by more are rejected
  /// From coarse to fine; each takes every so-many-th pixel of the source in both directions, half as many as
  /// the one before, the last one all.
  int levels = 3;
  int iterations = 10;          ///< at most, in each level
  double coarse_distance = 80;  ///< mm, of the coarsest level; those between by equal factors
  double coarse_angle = 1.0472; ///< radians (60 degrees), likewise, by equal steps
  double damping = 1e-4;        ///< pull to the start, as a share of the mean diagonal of J^T J
  double tolerance = 0.02;      ///< mm at the extent of the source; a shorter step ends a level
  // A pose is no answer:
  double min_overlap = 0.1;  ///< where a smaller share of the source meets a point of the target
  double min_inliers = 0.5;  ///< where a smaller share of what meets one has an accepted match
  double max_error = 5;      ///< mm, where these are further from the planes of their matches
  double max_shift = 200;    ///< mm, where the middle of the source moved further than that from the start
  double max_turn = 0.5236;  ///< radians (30 degrees), where it turned further
};

/// Projective ICP on the device [thesis 3.3]: all points of the source, matched with the point of the target
/// at their pixel, constant weights, rejection by distance and by the angle between normals; point to plane
/// with the normals of the source, which is fused from many frames; a Gauss-Newton step by Cholesky. Coarse
/// levels take fewer points and reach further.
///
/// Directions that the surface does not tell, as a plane's sliding, stay at the start: each step pulls back to
/// it by `damping`, which what is told hardly notices.
class ProjectiveIcp : public PoseEstimator {
 public:
  ProjectiveIcp(Device& device, const ProjectiveIcpOptions& options);

  PoseEstimate estimate(const SurfaceMap& source, const SurfaceMap& target,
                        const Eigen::Isometry3d& start) override;

  /// One matching of all points at a pose, by the limits of the last level.
  RigidEquations equations(const SurfaceMap& source, const SurfaceMap& target, const Eigen::Isometry3d& pose);

 private:
  struct Level {
    int number;
    int step;  ///< pixels
    float max_distance;
    float least_cosine;
  };
  struct State;

  std::vector<Level> levels_for(const PixelWindow& window) const;
  void begin(const SurfaceMap& source, int step, const Eigen::Isometry3d& start);
  void iterate(const Level& level, const SurfaceMap& source, const SurfaceMap& target);
  State read_state() const;
  void judge(PoseEstimate& estimate, const State& state) const;

  Device* device_;
  ProjectiveIcpOptions options_;
  Array<float> partials_;
  Array<float> state_;
};

/// Plain C++ references in double, pixel by pixel.
RigidEquations projective_equations_reference(const SurfaceMap& source, const SurfaceMap& target,
                                              const Eigen::Isometry3d& pose, const Eigen::Vector3d& pivot,
                                              const ProjectiveIcpOptions& options);

}  // namespace pliant
