#pragma once

#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_window.h"

namespace pliant {

/// The depth that a rig's colour camera would measure of what its depth image shows: of all depth as a mesh
/// over neighbouring pixels that differ by less than `default_depth_step`. 0 where it sees nothing, as
/// between surfaces and beside what the depth camera sees, and outside of a window of the colour image.
/// Without a colour camera of its own the depth is returned as it is.
DepthImage depth_at_color(const DepthImage& depth, const Rig& rig, const PixelWindow& window);

/// The colour of a frame at the pixels of its depth: each pixel's point is projected into the colour camera
/// and takes the colour of the pixel it falls in. Black where there is no depth, where the point lies outside
/// of the colour image, and where the colour camera sees something nearer than the point by
/// `default_depth_step` or more (depth_at_color): a colour of what hides it would be worse than none. What
/// hides is all of the frame's depth, whether a mask has it or not. Without a colour camera of its own the
/// colour is returned as it is. The frame must fit the rig
/// (`check`).
ColorImage color_at_depth(const Frame& frame, const Rig& rig);

}  // namespace pliant
