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

/// Measures residuals on the device.
class ResidualMeter {
 public:
  /// `cut`: mm, of Residual::robust.
  ResidualMeter(Device& device, const Correspondence& correspondence, const SurfaceMap& target,
                std::size_t point_count, double cut);
  /// Only enqueues.
  void measure(const PointSet& moved);
  /// Waits for the last measurement.
  Residual read() const;
  /// What was measured last, point by point, in mm; -1 where a point has no match that is accepted.
  const Array<float>& per_point() const { return per_point_; }

 private:
  Device* device_;
  const Correspondence* correspondence_;
  const SurfaceMap* target_;
  std::size_t chunks_;
  float cut_;
  Array<float> per_point_;
  Buffer partials_;
  Array<float> total_;
};

/// Plain C++ reference of ResidualMeter from what it has measured `per_point`.
Residual sum_residuals_reference(const SurfaceMap& target, const Array<float>& moved,
                                 const std::vector<float>& per_point, double cut);

}  // namespace pliant
