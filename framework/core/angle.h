#pragma once

#include <cmath>
#include <numbers>

namespace pliant {

/// In radians: a number of degrees times this is in radians, one of radians divided by this in degrees.
inline constexpr double degree = std::numbers::pi / 180;

/// As a parameter in degrees shows a default that the program has in radians.
inline double whole_degrees(double radians) { return std::round(radians / degree); }

}  // namespace pliant
