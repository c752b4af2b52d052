#pragma once

#include <optional>

#include "framework/core/registry.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// Finds the object in a frame [thesis 3.1]. For reconstruction the region is fixed once it is found.
class Segmentation {
 public:
  static constexpr const char* kind = "segmentation";
  virtual ~Segmentation() = default;
  /// The part of the depth image that shows the object; none where it is not found. `frame` fits `rig`; what
  /// has been cut from its depth is 0 there. Throws DataError when the frame lacks what the method looks at,
  /// as colour.
  virtual std::optional<PixelWindow> find(const Frame& frame, const Rig& rig) const = 0;
};

/// Adds `none`, `bounding_box`, `mask` and `haar`.
void register_segmentations(Registry& registry);

}  // namespace pliant
