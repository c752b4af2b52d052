#pragma once

#include <numbers>

namespace pliant {

/// In radians: a number of degrees times this is in radians, one of radians divided by this in degrees.
inline constexpr double degree = std::numbers::pi / 180;

}  // namespace pliant
