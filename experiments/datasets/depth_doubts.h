#pragma once

#include <string>
#include <vector>

#include "framework/geometry/frame.h"

namespace pliant {

/// What is odd about the depth of a frame, a line each that names its file `path`; `depth_scale` is what its
/// numbers were multiplied with to be mm:
///  - the median lies outside 100 mm to 10 m, or all depths are multiples of 5 mm, as of files that count
///  5000
///    units a metre: probably another unit;
///  - most points have fewer than three others in the window that normals are fitted to, or even in the
///  widest
///    one: what can be had from it is coarse.
/// Only pixels inside the mask count, where there is one. Nothing is said of a frame that sees nothing.
std::vector<std::string> doubts_about_depth(const Frame& frame, double depth_scale, const std::string& path);

}  // namespace pliant
