#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// A face in the colour image [Viola, Jones 2001: Rapid object detection using a boosted cascade of simple
/// features], found by OpenCV and carried to the depth image (window_at_depth). Of several faces it is the
/// largest in the colour image that has depth, and of equally large ones the upper, then the left one. A
/// frame without colour is a DataError.
void register_haar(Registry& registry);

}  // namespace pliant
