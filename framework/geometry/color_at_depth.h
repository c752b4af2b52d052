#pragma once

#include "framework/geometry/frame.h"

namespace pliant {

/// The colour of a frame at the pixels of its depth: each pixel's point is projected into the colour camera
/// and takes the colour of the pixel it falls in. Black where there is no depth, where the point lies outside
/// of the colour image, and where the colour camera sees something nearer than the point by
/// `default_depth_step` or more: a colour of what hides it would be worse than none. What hides is all of the
/// frame's depth as a mesh over neighbouring pixels that differ by less than that, whether a mask has it or
/// not. Without a colour camera of its own the colour is returned as it is. The frame must fit the rig
/// (`check`).
ColorImage color_at_depth(const Frame& frame, const Rig& rig);

}  // namespace pliant
