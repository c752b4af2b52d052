#pragma once

#include <optional>

#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// Where the depth image shows what a window of the colour image shows. Every depth pixel's point is
/// projected into the colour camera. How far the object is, is the median depth (in the colour camera's
/// frame) of the points that fall into the middle half of the window, in width and height. The answer is the
/// bounding window of the pixels whose points fall into the window and lie no more than `depth_band` mm
/// before or behind that: what else the window shows, or only the depth camera sees behind the object, takes
/// no part, nor do specks (window_of_parts). None where no depth is left.
std::optional<PixelWindow> window_at_depth(const PixelWindow& color_window, const Frame& frame,
                                           const Rig& rig, double depth_band, int speck);

}  // namespace pliant
