#pragma once

#include "framework/device/array.h"
#include "framework/registration/target.h"

namespace pliant {

/// How far a deformed source lies from its target, by projective association, nothing rejected.
struct Residual {
  double mean = 0;  ///< mm, over the points that land on a target point; 0 when none does
  int landed = 0;   ///< how many those are
  int lost = 0;     ///< points that are not finite, or further away than farthest_depth
};

/// Measures residuals on the device; reading one back waits for everything enqueued so far.
class ResidualMeter {
 public:
  ResidualMeter(Device& device, const Target& target, std::size_t point_count);
  /// `moved`: x y z of each of the points, mm.
  Residual measure(const Array<float>& moved);
  /// What was measured last, point by point, in mm; -1 where a point meets no target point.
  const Array<float>& per_point() const { return per_point_; }

 private:
  Device* device_;
  const Target* target_;
  std::size_t chunks_;
  Array<float> per_point_;
  cl::Buffer partials_;
  cl::Buffer total_;
};

/// Plain C++ reference of ResidualMeter: fills `per_point`.
Residual measure_residual_reference(const Target& target, const Array<float>& moved,
                                    std::vector<float>& per_point);

}  // namespace pliant
