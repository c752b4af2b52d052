#pragma once

#include "framework/core/registry.h"
#include "framework/registration/sampler.h"

namespace pliant {

/// Constrains many points where the surface does not fit yet and few where it does [thesis 4.5].
///
/// An n x n mask moves in steps of n over the image. At first its centre is constrained, where there is a
/// point. Then, with E the mean of the residuals known in it: above the threshold all of its points; down to
/// half the threshold n points spread evenly (one in each column and row); below, or where no residual is
/// known, its centre.
class AdaptiveSampler : public ConstraintSampler {
 public:
  /// `step`: n, pixels; `threshold` in mm. `equal_masks`: constraints weigh so that every mask does the same,
  /// however many it has; else each weighs 1.
  AdaptiveSampler(int step, double threshold, bool equal_masks);

  std::unique_ptr<PointSelection> select(Device& device, const SurfaceView& source) const override;

 private:
  int step_;
  float threshold_;
  bool equal_masks_;
};

/// Adds the sampler `adaptive`.
void register_adaptive_sampler(Registry& registry);

}  // namespace pliant
