#pragma once

#include "framework/device/array.h"
#include "framework/registration/target.h"

namespace pliant {

/// How far a deformed source lies from its target, by projective association, nothing rejected.
struct Residual {
  double mean = 0;  ///< mm, over the points that land on a target point; 0 when none does
  int landed = 0;   ///< how many those are
};

/// Measures residuals on the device; reading one back waits for everything enqueued so far.
class ResidualMeter {
 public:
  ResidualMeter(Device& device, const Target& target, std::size_t point_count);
  /// `moved`: x y z of each of the points, mm.
  Residual measure(const Array<float>& moved);

 private:
  Device* device_;
  const Target* target_;
  std::size_t chunks_;
  cl::Buffer partials_;
  cl::Buffer total_;
};

/// Plain C++ reference of ResidualMeter::measure.
Residual measure_residual_reference(const Target& target, const Array<float>& moved);

}  // namespace pliant
