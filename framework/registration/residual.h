#pragma once

#include "framework/registration/correspondence.h"

namespace pliant {

/// How far a deformed source lies from the matches that are accepted for it.
struct Residual {
  double mean = 0;  ///< mm, over the points that have such a match; 0 when none has
  int matched = 0;  ///< how many those are
  int landed = 0;   ///< these, and those that project onto a target point which is rejected
  int lost = 0;     ///< points that are not finite, or further away than farthest_depth
  /// mm; root mean square over all points, where one without such a match or with a longer residual counts as
  /// the meter's cut: what rises when matches are lost, and heeds no outlier more than that.
  double robust = 0;
  double deviation = 0;  ///< mm, standard deviation of what `mean` is of
};

/// Adds up residuals on the device.
class ResidualSum {
 public:
  /// `cut`: mm, of Residual::robust. The device must outlive this.
  ResidualSum(Device& device, std::size_t point_count, double cut);
  /// `residuals` of the points `moved`: mm, -1 where one has no match that is accepted. Only enqueues.
  void add_up(const Array<float>& residuals, const PointSet& moved, const SurfaceMap& target);
  /// Waits for the last sum.
  Residual read() const;

 private:
  Device* device_;
  std::size_t count_;
  std::size_t chunks_;
  float cut_;
  Buffer partials_;
  Array<float> total_;
};

/// Measures residuals on the device.
class ResidualMeter {
 public:
  /// `cut`: mm, of Residual::robust. Both must outlive this.
  ResidualMeter(Device& device, const Correspondence& correspondence, std::size_t point_count, double cut)
      : device_(&device),
        correspondence_(&correspondence),
        per_point_(point_count),
        sum_(device, point_count, cut) {}
  /// Only enqueues.
  void measure(const PointSet& moved, const SurfaceMap& target) {
    correspondence_->measure(*device_, moved, target, per_point_);
    sum_.add_up(per_point_, moved, target);
  }
  /// Waits for the last measurement.
  Residual read() const { return sum_.read(); }
  /// What was measured last, point by point, in mm; -1 where a point has no match that is accepted.
  const Array<float>& per_point() const { return per_point_; }

 private:
  Device* device_;
  const Correspondence* correspondence_;
  Array<float> per_point_;
  ResidualSum sum_;
};

/// Plain C++ reference of ResidualMeter from what it has measured `per_point`.
Residual sum_residuals_reference(const SurfaceMap& target, const Array<float>& moved,
                                 const std::vector<float>& per_point, double cut);

}  // namespace pliant
