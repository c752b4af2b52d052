#pragma once

#include <optional>

#include "framework/core/registry.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// The part of a depth image that shows an object.
struct Region {
  PixelWindow window;
  MaskImage mask = {};  ///< of the depth's size, not zero on the object; empty: all of the window
};

/// Takes what lies outside of a region off the frame's mask, which DepthMap heeds. Depth stays as it is: what
/// is beside the object may still hide something. Throws std::invalid_argument when the region reaches beyond
/// the depth image or its mask has another size.
void cut_to(const Region& region, Frame& frame);

/// Finds the object in a frame [thesis 3.1]. For reconstruction the region is fixed once it is found.
class Segmentation {
 public:
  static constexpr const char* kind = "segmentation";
  virtual ~Segmentation() = default;
  /// The part of the depth image that shows the object; none where it is not found. `frame` fits `rig`; what
  /// has been cut from its depth is 0 there. Throws DataError when the frame lacks what the method looks at,
  /// as colour. Not to be called from two threads at once.
  virtual std::optional<Region> find(const Frame& frame, const Rig& rig) const = 0;
};

}  // namespace pliant
