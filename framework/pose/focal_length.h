#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/device/array.h"
#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"
#include "framework/pose/projective_icp.h"
#include "framework/pose/rigid_step.h"

namespace pliant {

/// Normal equations of point-to-plane distances between two views by a small rigid motion and by a relative
/// change of the focal length that both were made with.
struct FocalLengthEquations {
  RigidEquations motion;
  Eigen::Matrix<double, 6, 1> mixed = Eigen::Matrix<double, 6, 1>::Zero();  ///< by motion and focal length
  double curvature = 0;  ///< by the focal length twice, mm^2
  double gradient = 0;   ///< mm^2
};

/// With which focal length views of one rigid thing fit together.
struct FocalLengthEstimate {
  double change = 0;  ///< relative to the one that is used: 0.1 where views fit best with one 10 % greater
  /// Standard deviation of what one view tells: by how far they differ, and by the normal equations and the
  /// distances between the views. More views do not lower it: neighbouring ones err alike, and all of them as
  /// the first does.
  double error = 0;
  int views = 0;  ///< that were compared with the first
  /// Whether the one that is used is wrong: at least five views say so, by more than 5 % and by more than
  /// three times the error.
  bool is_wrong() const;
};

/// Self-calibration as a measure of quality: a wrong focal length stretches what a camera sees across its
/// axis, so that a thing that is seen from two sides has two forms. Each view is compared with the first, not
/// with a fused model, which takes on the wrong form. A point p of a view moves by (-x, -y, 0) ds with a
/// relative change ds of the focal length; the motion between both views is eliminated.
///
/// Where the camera does not turn about the thing, or only about its own axis, nothing is told.
class FocalLengthCheck {
 public:
  /// `first`: what the first view shows; it is copied. `device` must outlive this.
  FocalLengthCheck(Device& device, const SurfaceMap& first);

  /// Compares a view with the first, mm from that one's frame to its own. Leaves out those from whose
  /// direction one was compared, within 2 degrees. Waits for the device.
  void add(const SurfaceMap& view, const Eigen::Isometry3d& view_from_first);
  FocalLengthEstimate estimate() const;

  /// What a view tells at a pose, its motion about where the first's middle is moved to.
  FocalLengthEquations equations(const SurfaceMap& view, const Eigen::Isometry3d& view_from_first);

 private:
  Device* device_;
  SurfaceMap first_;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  Array<float> partials_;
  std::vector<float> sums_;
  Eigen::Vector3d last_axis_ = Eigen::Vector3d::UnitZ();
  int views_ = 0;
  // Over the views: sums of curvature and gradient, and of their squares and products; of mean squared
  // distances.
  double curvature_ = 0, gradient_ = 0, variances_ = 0;
  Eigen::Matrix2d products_ = Eigen::Matrix2d::Zero();
};

/// Which points of two views match: as in ICP's finest level, but twice as far apart where depth is noisy,
/// because a wrong focal length parts what is far away by more than noise does.
ProjectiveIcpLevel focal_length_limits(const PixelWindow& window);

/// Plain C++ reference of the equations in double, pixel by pixel, about a pivot (mm, the view's frame).
FocalLengthEquations focal_length_equations_reference(const SurfaceMap& first, const SurfaceMap& view,
                                                      const Eigen::Isometry3d& view_from_first,
                                                      const Eigen::Vector3d& pivot);

}  // namespace pliant
