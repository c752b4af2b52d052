#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/core/angle.h"
#include "framework/device/array.h"
#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/pose_estimator.h"
#include "framework/pose/rigid_step.h"

namespace pliant {

struct ProjectiveIcpOptions {
  double max_distance = 10;  ///< mm; matches further apart are rejected
  /// A match may be further apart by so many standard deviations of a structured-light camera's depth, 1.2 +
  /// 1.9 (z - 0.4)^2 mm with z in metres [Nguyen, Izadi, Lovell 2012]: beyond 1.5 m these are more than
  /// 10 mm. 0: it may not.
  double noise = 3;
  /// Radians; matches whose normals differ by more are rejected. A point of the target without a
  /// normal, as at a rim, is judged by distance.
  double max_angle = 20 * degree;
  /// From coarse to fine. The last one takes all points of the source, each before it half as many in u and
  /// v.
  int levels = 3;
  int iterations = 10;                ///< at most, in each level
  double coarse_distance = 80;        ///< mm, of the coarsest level; those between by equal factors
  double coarse_angle = 60 * degree;  ///< radians, likewise, by equal steps
  double tolerance = 0.05;            ///< mm at the extent of the source; a shorter step ends the last level
  /// Pull to the start in the last level, as a share of the mean diagonal of J^T J with turns in mm at the
  /// source's extent.
  double damping = 1e-4;
  // A pose is a failure:
  double min_overlap = 0.1;       ///< where a smaller share of the source meets a point of the target
  double min_inliers = 0.3;       ///< where a smaller share of what meets one has an accepted match
  double max_shift = 150;         ///< mm, where both the camera and the middle of the source moved further
  double max_turn = 20 * degree;  ///< radians, where it turned further from the start
};

/// A level for a source in some window.
struct ProjectiveIcpLevel {
  int step;  ///< pixels in u and v
  double max_distance;
  double noise;
  double max_angle;
  double tolerance;  ///< mm
  double damping;    ///< fewer points outweigh less of the pull to the start
  /// How far from a point of the target at this depth (mm) its match may be.
  double farthest(double depth) const;
};
std::vector<ProjectiveIcpLevel> levels_of(const ProjectiveIcpOptions& options, const PixelWindow& window);

/// What the last matching of an estimate tells.
struct ProjectiveIcpState {
  Eigen::Isometry3d pose;    ///< after the step that it led to
  RigidEquations equations;  ///< before
  Eigen::Vector3d middle;    ///< of the source, mm
  double extent;             ///< root mean square distance of its points from there, mm
  int iterations;
  bool gave_up;  ///< no step could be made
};

/// Projective ICP on the device [thesis 3.3]: all points of the source, matched with the point of the target
/// at their pixel, constant weights, rejection by distance and by the angle between normals; point to plane
/// with the normals of the source, which is fused from many frames; a Gauss-Newton step by Cholesky. Coarse
/// levels take fewer points and reach further.
///
/// Directions that the surface does not tell, as a plane's sliding, stay at the start: each step pulls back
/// to it by `damping`, which what is told hardly notices. Those that it pulls by more than a tenth count as
/// weak.
///
/// A pose is a failure by the last four options, when the matches lie as far from their planes as any that
/// were accepted at random would, or when no step can be made.
class ProjectiveIcp : public PoseEstimator {
 public:
  ProjectiveIcp(Device& device, const ProjectiveIcpOptions& options);

  PoseEstimate estimate(const SurfaceMap& source, const SurfaceMap& target,
                        const Eigen::Isometry3d& start) override;

  /// One matching of all points at a pose, by the limits of the last level.
  RigidEquations equations(const SurfaceMap& source, const SurfaceMap& target, const Eigen::Isometry3d& pose);

 private:
  void begin(const SurfaceMap& source, int step, const Eigen::Isometry3d& start);
  void iterate(int number, const ProjectiveIcpLevel& level, const SurfaceMap& source,
               const SurfaceMap& target);
  ProjectiveIcpState read_state() const;

  Device* device_;
  ProjectiveIcpOptions options_;
  Array<float> partials_;
  Array<float> state_;
};

/// The estimate with its judgement.
PoseEstimate judged(const ProjectiveIcpState& state, const Eigen::Isometry3d& start,
                    const ProjectiveIcpOptions& options);

/// Plain C++ references in double, pixel by pixel, of ProjectiveIcp::equations about a pivot (mm, where the
/// middle of the source is moved to), and of the whole estimate.
RigidEquations projective_equations_reference(const SurfaceMap& source, const SurfaceMap& target,
                                              const Eigen::Isometry3d& pose, const Eigen::Vector3d& pivot,
                                              const ProjectiveIcpLevel& level);
PoseEstimate projective_icp_reference(const SurfaceMap& source, const SurfaceMap& target,
                                      const Eigen::Isometry3d& start, const ProjectiveIcpOptions& options);

}  // namespace pliant
