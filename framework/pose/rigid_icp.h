#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "framework/core/angle.h"
#include "framework/device/array.h"
#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/rigid_step.h"

namespace pliant {

struct RigidIcpOptions {
  double max_distance = 10;        ///< mm; matches further apart are rejected
  double max_angle = 20 * degree;  ///< radians; matches whose normals differ by more are rejected
  int step = 1;                    ///< every so-many-th point of the source is matched, 1: all
  int levels = 4;                  ///< from coarse to fine
  int iterations = 10;             ///< at most, in each level
  /// Of the coarsest level, in extents of the source (root mean square distance of its points from their
  /// mean). The levels go from there down to max_distance by equal factors.
  double coarse_distance = 1;
  double coarse_angle = 75 * degree;  ///< radians, likewise, by equal steps
  /// In the last level, once it has matches: those are rejected too whose distance to the plane is more than
  /// this many root mean squares of the last accepted ones (a tenth of max_distance at least). What deforms
  /// does not pull at the rest then. 0: none are.
  double trim = 2.5;
  /// Radians. Beside the given start, starts are tried that put the middle of the source on that of the
  /// target: unturned, turned by this about each axis and about both diagonals of x and y, and by twice this
  /// about x and y, all of them both ways. The best by TwoWayResidual after the coarsest level goes on. 0:
  /// only the given one.
  double search_angle = 30 * degree;
};

/// A surface as a camera sees it, and which of its pixels count.
struct SeenSurface {
  const SurfaceMap& map;
  const Array<int>& pixels;  ///< offsets in the map's window of pixels that have a point
};

/// How ill a pose explains what both cameras saw: the mean distance of the moved source from the target at
/// the same pixel, and of the target, moved back, from the source. A point where the other map has nothing,
/// or something further away, is `cut` away. What faces away in the other camera, or leaves its view, does
/// not count; with less than a quarter left a direction counts as `cut`.
struct TwoWayResidual {
  double mean = 0;  ///< of both directions, mm
  double cut = 0;   ///< a quarter of the source's extent, mm
};

struct RigidIcpResult {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< moves the source to the target; mm
  int samples = 0;        ///< points of the source that were matched in the last level
  int inliers = 0;        ///< of them, how many have an accepted match
  double mean_error = 0;  ///< root mean square distance of the inliers to the planes of their matches, mm
  TwoWayResidual before;  ///< at the start that was given
  TwoWayResidual after;   ///< at `pose`
  /// Least eigenvalue over the greatest of J^T J at `pose`, turns measured in mm at the source's extent: near
  /// 0 where the surface may slide or turn along itself.
  double conditioning = 0;
  int iterations = 0;  ///< in all levels
  /// Whether the last step of the last level was shorter than a thousandth of max_distance.
  bool converged = false;
  /// Whether the pose is no answer: too few accepted matches, or no finite step.
  bool failed = false;
  std::string reason;  ///< why it failed or did not converge; else empty
};

/// Rigid ICP on the device [thesis 3.3]: projective matches with constant weights, rejected by distance and
/// by the angle between normals; point to plane; coarse to fine. The host waits once, at the end. Buffers are
/// kept between calls. The same input gives the same bits.
class RigidIcp {
 public:
  RigidIcp(Device& device, const RigidIcpOptions& options);

  /// From `start` (mm, camera frame), or from further starts around it (RigidIcpOptions::search_angle).
  RigidIcpResult align(const SeenSurface& source, const SeenSurface& target, const Eigen::Isometry3d& start);

  TwoWayResidual residual(const SeenSurface& source, const SeenSurface& target,
                          const Eigen::Isometry3d& pose);

  /// One matching at a pose, by the limits of the last level.
  RigidEquations equations(const SeenSurface& source, const SeenSurface& target,
                           const Eigen::Isometry3d& pose);

 private:
  /// Points and normals of every so-many-th pixel, coordinate by coordinate.
  struct Samples {
    Array<float> values;
    int count = 0;
    int padded = 0;
  };
  struct Level {
    int number;
    double share;  ///< of the way from max_distance to the coarsest level's distance
    Samples samples;
  };

  struct Start {
    Eigen::Isometry3d pose;
    bool is_centred;  ///< puts the middle of the source on that of the target, only turned by `pose`
  };

  void prepare(const SeenSurface& source, const SeenSurface& target);
  void pack(const SeenSurface& surface, int stride, Samples& samples);
  void set_out(const std::vector<Start>& starts);
  cl_float trim_of(const Level& level) const;
  void refine(const Level& level, int poses, const SeenSurface& target);
  void accumulate(const Level& level, int number, int poses, const SeenSurface& target);
  void judge(int poses, const SeenSurface& source, const SeenSurface& target);
  Eigen::Vector4d read_extent();
  std::vector<TwoWayResidual> read_residuals(std::size_t count);
  RigidEquations read_sums();
  RigidIcpResult read_result();

  Device* device_;
  RigidIcpOptions options_;
  std::vector<Level> levels_;
  Samples target_samples_;
  Array<float> extents_;
  Array<float> starts_;
  Array<float> poses_;
  Array<float> partials_;
  Array<float> sums_;
  Array<float> judged_;
  Array<float> residuals_;
};

/// Plain C++ references of RigidIcp::equations and RigidIcp::residual, over all pixels of the surfaces.
/// `pivot` and `cut` as they are in what these give.
RigidEquations rigid_equations_reference(const SeenSurface& source, const SeenSurface& target,
                                         const Eigen::Isometry3d& pose, const Eigen::Vector3d& pivot,
                                         const RigidIcpOptions& options);
TwoWayResidual two_way_residual_reference(const SeenSurface& source, const SeenSurface& target,
                                          const Eigen::Isometry3d& pose, double cut);

}  // namespace pliant
