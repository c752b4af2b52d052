#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/geometry/image.h"

namespace pliant {

/// Which numbers the colours stand for; values beyond are shown in the colour of the nearer end.
struct ColorScale {
  enum class Map { depth, error };
  Map map = Map::depth;
  float lowest = 0;   ///< mm
  float highest = 1;  ///< mm, above `lowest`
};

/// The 256 colours of a perceptually uniform map, lowest first.
std::array<Rgb, 256> colors_of(ColorScale::Map map);
/// Of pixels without a value.
inline constexpr Rgb no_color{231, 233, 236};

/// Which colour of its map a finite value has.
inline std::size_t color_index(const ColorScale& scale, float value) {
  const float part = (value - scale.lowest) / (scale.highest - scale.lowest);
  return static_cast<std::size_t>(std::lround(255 * std::clamp(part, 0.0F, 1.0F)));
}

/// The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8 times a power of ten that is not below `value` > 0.
double round_up(double value);

/// An image in mm (NaN: none) in colours, with a labelled colour bar, a title and a line below it, as a
/// PNG. Small images are enlarged so that the text has room.
std::vector<std::uint8_t> draw_heat_map(const Image<float>& values, const ColorScale& scale,
                                        const std::string& title, const std::string& subtitle);

}  // namespace pliant
