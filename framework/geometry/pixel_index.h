#pragma once

#include "framework/geometry/image.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Which point of a surface is seen at each pixel of the bounding box of its projection.
struct PixelIndex {
  int left = 0;  ///< pixel of the camera's image at the corner of the box
  int top = 0;
  Image<int> points;  ///< index of the point; -1 where there is none
};

PixelIndex index_pixels(const Surface& surface);

}  // namespace pliant
