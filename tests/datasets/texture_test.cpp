#include "experiments/datasets/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace pliant {
namespace {

int difference(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

TEST(Texture, IsSmoothAlongEveryAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    for (double at = -60; at < 60; at += 0.05) {
      Eigen::Vector3d point(3.3, -17.1, 8.8);
      point[axis] = at;
      Eigen::Vector3d next = point;
      next[axis] += 0.05;
      // No channel can change faster than 1.5 / cell a layer, averaged: 0.093 a mm, of 255.
      EXPECT_LE(difference(texture_color(point), texture_color(next)), 3) << point.transpose();
    }
  }
}

TEST(Texture, TellsPlacesApart) {
  // Every channel must vary widely over a few cells, along every axis, and on its own.
  for (int axis = 0; axis < 3; ++axis) {
    std::array<int, 3> low = {255, 255, 255};
    std::array<int, 3> high = {0, 0, 0};
    int differing = 0;
    for (int i = 0; i < 400; ++i) {
      Eigen::Vector3d point(0.5, 0.5, 0.5);
      point[axis] += i;
      const Rgb color = texture_color(point);
      const std::array<int, 3> channels = {color.r, color.g, color.b};
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], channels[c]);
        high[c] = std::max(high[c], channels[c]);
      }
      differing += std::abs(color.r - color.g) > 10 ? 1 : 0;
    }
    for (std::size_t c = 0; c < 3; ++c) EXPECT_GT(high[c] - low[c], 100);
    EXPECT_GT(differing, 200);
  }
}

}  // namespace
}  // namespace pliant
