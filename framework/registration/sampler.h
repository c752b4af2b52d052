#pragma once

#include <memory>

#include "framework/geometry/camera.h"
#include "framework/geometry/point_selection.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Chooses which points of the source are constrained to go to the target [thesis 4.5].
class ConstraintSampler {
 public:
  static constexpr const char* kind = "sampler";
  virtual ~ConstraintSampler() = default;
  /// `source`: pixels are those of the camera's image. Both must outlive what is returned.
  virtual std::unique_ptr<PointSelection> select(Device& device, const Surface& source,
                                                 const Camera& camera) const = 0;
};

}  // namespace pliant
