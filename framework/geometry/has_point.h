#pragma once

#include "framework/geometry/frame.h"

namespace pliant {

/// Whether a frame shows a point of the object at a pixel: it has depth, and lies on the mask if there is
/// one.
inline bool has_point(const Frame& frame, int u, int v) {
  return is_depth(frame.depth(u, v)) && (frame.mask.empty() || frame.mask(u, v) != 0);
}

/// The same by the pixel's row-major offset.
inline bool has_point(const Frame& frame, std::size_t pixel) {
  return is_depth(frame.depth.data()[pixel]) && (frame.mask.empty() || frame.mask.data()[pixel] != 0);
}

/// Whether it does so anywhere.
inline bool sees_something(const Frame& frame) {
  for (std::size_t pixel = 0; pixel < frame.depth.size(); ++pixel)
    if (has_point(frame, pixel)) return true;
  return false;
}

}  // namespace pliant
