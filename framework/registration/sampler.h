#pragma once

#include <memory>

#include "framework/geometry/pixel_index.h"
#include "framework/geometry/point_selection.h"

namespace pliant {

/// Chooses which points of the source are constrained to go to the target [thesis 4.5].
class ConstraintSampler {
 public:
  static constexpr const char* kind = "sampler";
  virtual ~ConstraintSampler() = default;
  /// What is returned keeps nothing of `source`.
  virtual std::unique_ptr<PointSelection> select(Device& device, const SurfaceView& source) const = 0;
};

}  // namespace pliant
