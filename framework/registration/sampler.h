#pragma once

#include <vector>

#include "framework/geometry/surface.h"

namespace pliant {

/// Chooses which points of the source are constrained to go to the target [thesis 4.5].
class ConstraintSampler {
 public:
  static constexpr const char* kind = "sampler";
  virtual ~ConstraintSampler() = default;
  /// Indices of points of `source`, ascending, without repetition.
  virtual std::vector<int> select(const Surface& source) const = 0;
};

}  // namespace pliant
