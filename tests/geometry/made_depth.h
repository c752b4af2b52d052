#pragma once

#include <cmath>
#include <random>

#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// Depth with what makes depth hard: curved ground, a step, noise of about 2 mm and holes; without noise
/// `noise` is 0. The same bits every time.
inline Frame made_depth(const Camera& camera, double noise = 2) {
  Frame frame{DepthImage(camera.width, camera.height), {}, {}};
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<double>(random()) / std::mt19937::max() - 0.5; };
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double ground = 900 + 60 * std::sin(0.02 * u) + 40 * std::cos(0.03 * v);
      const double step = u > 2 * camera.width / 3 ? 250 : 0;
      const double disturbance = noise * (uniform() + uniform() + uniform() + uniform()) * 1.7;
      const bool is_hole = random() % 12 == 0;
      frame.depth(u, v) = is_hole ? 0.0F : static_cast<float>(ground + step + disturbance);
    }
  }
  return frame;
}

}  // namespace pliant
