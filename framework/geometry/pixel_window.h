#pragma once

#include <cstddef>

#include "framework/geometry/camera.h"

namespace pliant {

/// A rectangle of pixels of a camera's image. What is kept for its pixels lies row by row.
struct PixelWindow {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;

  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  /// (u, v): a pixel of the image.
  bool contains(int u, int v) const { return u >= left && v >= top && u < left + width && v < top + height; }
  /// Where what is kept for a pixel of the window lies.
  std::size_t offset(int u, int v) const {
    return static_cast<std::size_t>(v - top) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(u - left);
  }
  bool operator==(const PixelWindow&) const = default;
};

inline PixelWindow whole_image(const Camera& camera) { return {0, 0, camera.width, camera.height}; }

}  // namespace pliant
