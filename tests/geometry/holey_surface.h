#pragma once

#include <random>
#include <vector>

#include "framework/geometry/surface.h"

namespace pliant {

/// A round object of `width` x `height` pixels in the midst of an image, with round holes of many sizes in it
/// and single pixels missing. The same bits for the same seed.
inline Surface holey_surface(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
  struct Hole {
    int u, v, radius;
  };
  std::vector<Hole> holes;
  for (int i = 0; i < 12; ++i) holes.push_back({below(width), below(height), 1 + below(width / 8)});
  const auto is_object = [&](int u, int v) {
    for (const Hole& hole : holes)
      if ((u - hole.u) * (u - hole.u) + (v - hole.v) * (v - hole.v) <= hole.radius * hole.radius)
        return false;
    const double x = (2.0 * u + 1) / width - 1;
    const double y = (2.0 * v + 1) / height - 1;
    return x * x + y * y < 1;
  };
  Surface surface;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      if (!is_object(u, v) || below(20) == 0) continue;
      surface.pixels.emplace_back(37 + u, 21 + v);
      surface.points.emplace_back(1.5F * static_cast<float>(u), 1.5F * static_cast<float>(v), 800.0F);
      surface.normals.emplace_back(0.0F, 0.0F, -1.0F);
    }
  return surface;
}

/// One residual a point: blocks of 7 pixels fit well or badly, every point a little different, some unknown
/// (-1). Eighths of a millimetre, so that their sums are exact in single precision in whatever order.
inline std::vector<float> patchy_residuals(const Surface& surface, unsigned seed) {
  std::vector<float> residuals;
  std::mt19937 random(seed);
  for (const Eigen::Vector2i& pixel : surface.pixels) {
    const auto column = static_cast<unsigned>(pixel.x() / 7);
    const auto row = static_cast<unsigned>(pixel.y() / 7);
    std::mt19937 block(seed + 1000 * column + row);
    const auto eighths = block() % 30 + random() % 4;
    residuals.push_back(random() % 10 == 0 ? -1.0F : 0.125F * static_cast<float>(eighths));
  }
  return residuals;
}

}  // namespace pliant
