#include "framework/imaging/depth_map.h"

#include <algorithm>
#include <stdexcept>

#include "framework/imaging/plane_fit.h"

namespace pliant {
namespace {

/// Throws std::invalid_argument when mask and depth differ in size.
const Frame& checked(const Frame& frame) {
  const bool fits = frame.mask.empty() || (frame.mask.width() == frame.depth.width() &&
                                           frame.mask.height() == frame.depth.height());
  if (!fits) throw std::invalid_argument("mask and depth differ in size");
  return frame;
}

int round_up(int value, int step) { return (value + step - 1) / step * step; }

/// is_depth without a branch: compilers make vectors of loops over it.
bool has_depth(float depth) {
  return static_cast<bool>(static_cast<int>(depth > 0) & static_cast<int>(depth < farthest_depth));
}

bool any_depth(const float* row, int width) {
  int any = 0;
  for (int u = 0; u < width; ++u) any |= static_cast<int>(has_depth(row[u]));
  return any != 0;
}

/// The smallest window that holds all pixels with depth; empty when there is none.
PixelWindow window_of_depth(const Frame& frame) {
  const int width = frame.depth.width();
  const int height = frame.depth.height();
  int left = width, right = 0, top = height, bottom = 0;
  const auto counts = [](const float* row, const std::uint8_t* mask, int u) {
    return has_depth(row[u]) && (mask == nullptr || mask[u] != 0);
  };
  for (int v = 0; v < height; ++v) {
    const auto begin = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
    const float* row = frame.depth.data() + begin;
    const std::uint8_t* mask = frame.mask.empty() ? nullptr : frame.mask.data() + begin;
    if (!any_depth(row, width)) continue;
    int first = 0;
    while (first < width && !counts(row, mask, first)) ++first;
    if (first == width) continue;
    int last = width - 1;
    while (last >= right && !counts(row, mask, last)) --last;
    left = std::min(left, first);
    right = std::max(right, last + 1);
    top = std::min(top, v);
    bottom = v + 1;
  }
  return right > 0 ? PixelWindow{left, top, right - left, bottom - top} : PixelWindow{};
}

}  // namespace

DepthMap::DepthMap(const PixelWindow& window)
    : window(window),
      stride(round_up(window.width, halo) + 2 * halo),
      depth(static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows())) {}

DepthMap::DepthMap(const Frame& frame) : DepthMap(window_of_depth(checked(frame))) { take(frame); }

void DepthMap::take(const Frame& frame, float farthest) {
  checked(frame);
  std::vector<float>& values = depth.write_host();
  std::fill(values.data(), values.data() + offset(0, 0), no_depth);
  for (int row = 0; row < window.height; ++row) {
    float* to = values.data() + offset(0, row);
    const std::size_t begin =
        static_cast<std::size_t>(window.top + row) * static_cast<std::size_t>(frame.depth.width()) +
        static_cast<std::size_t>(window.left);
    const float* given = frame.depth.data() + begin;
    for (int u = 0; u < window.width; ++u)
      to[u] = has_depth(given[u]) && given[u] <= farthest ? given[u] : no_depth;
    std::fill(to + window.width, to + stride, no_depth);
    if (frame.mask.empty()) continue;
    const std::uint8_t* mask = frame.mask.data() + begin;
    for (int u = 0; u < window.width; ++u) to[u] = mask[u] != 0 ? to[u] : no_depth;
  }
  std::fill(values.data() + offset(0, window.height), values.data() + values.size(), no_depth);
}

DepthImage to_image(const DepthMap& map, const Camera& camera) {
  DepthImage image(camera.width, camera.height);
  for (int row = 0; row < map.window.height; ++row) {
    for (int column = 0; column < map.window.width; ++column) {
      const float depth = map.depth.host()[map.offset(column, row)];
      if (depth < DepthMap::no_depth) image(map.window.left + column, map.window.top + row) = depth;
    }
  }
  return image;
}

std::vector<int> pixels_with_depth(const DepthMap& map) {
  std::vector<int> pixels(map.window.size());
  std::size_t count = 0;
  for (int v = 0; v < map.window.height; ++v) {
    const float* row = map.depth.host().data() + map.offset(0, v);
    for (int u = 0; u < map.window.width; ++u) {
      // Written always and kept only where there is depth: no branch to mispredict.
      pixels[count] = v * map.window.width + u;
      count += row[u] < DepthMap::no_depth ? 1 : 0;
    }
  }
  pixels.resize(count);
  return pixels;
}

SurfaceMap unwritten_surface(const Camera& camera, const PixelWindow& window) {
  return {camera, window, {Array<float>(3 * window.size()), Array<float>(3 * window.size())}};
}

SurfaceMap make_surface_map(Device& device, const DepthMap& map, const Camera& camera, int radius,
                            float depth_step) {
  SurfaceMap surface = unwritten_surface(camera, map.window);
  PlaneFit(radius, depth_step).write(device, map, surface);
  return surface;
}

SurfaceImage make_surface_image(Device& device, const Frame& frame, const Camera& camera) {
  const SurfaceMap map = make_surface_map(device, DepthMap(frame), camera);
  const Image<Eigen::Vector3f> none(frame.depth.width(), frame.depth.height(), Eigen::Vector3f::Zero());
  SurfaceImage image{none, none};
  const auto points = unflatten(map.points());
  const auto normals = unflatten(map.normals());
  const PixelWindow& window = map.window;
  for (int v = window.top; v < window.top + window.height; ++v) {
    const std::size_t begin = window.offset(window.left, v);
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(begin), window.width,
                &image.points(window.left, v));
    std::copy_n(normals.begin() + static_cast<std::ptrdiff_t>(begin), window.width,
                &image.normals(window.left, v));
  }
  return image;
}

}  // namespace pliant
