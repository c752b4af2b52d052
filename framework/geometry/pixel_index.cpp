#include "framework/geometry/pixel_index.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace pliant {
namespace {

int seen_at(const PixelIndex& index, int u, int v) {
  return index.window.contains(u, v) ? index.points.host()[index.window.offset(u, v)] : -1;
}

}  // namespace

PixelIndex::PixelIndex(const PixelWindow& window, const std::vector<int>& pixels)
    : window(window), count(pixels.size()) {
  std::vector<int> seen(window.size(), -1);
  int point = 0;
  for (const int pixel : pixels) seen[static_cast<std::size_t>(pixel)] = point++;
  points = Array<int>(std::move(seen));
}

PixelIndex index_pixels(const Surface& surface) {
  if (surface.size() == 0) return {{}, {}};
  Eigen::Vector2i lowest = surface.pixels.front();
  Eigen::Vector2i highest = lowest;
  for (const Eigen::Vector2i& pixel : surface.pixels) {
    lowest = lowest.cwiseMin(pixel);
    highest = highest.cwiseMax(pixel);
  }
  const Eigen::Vector2i size = highest - lowest + Eigen::Vector2i::Ones();
  const PixelWindow window{lowest.x(), lowest.y(), size.x(), size.y()};
  std::vector<int> pixels;
  pixels.reserve(surface.size());
  for (const Eigen::Vector2i& pixel : surface.pixels)
    pixels.push_back(static_cast<int>(window.offset(pixel.x(), pixel.y())));
  return {window, pixels};
}

int point_at(const PixelIndex& index, const Eigen::Vector2i& pixel, const PixelBox& box) {
  if (const int point = seen_at(index, pixel.x(), pixel.y()); point >= 0) return point;
  int nearest = -1;
  int least = 2 * gap_radius * gap_radius + 1;
  int quadrants = 0;  // one bit each
  for (int dv = -gap_radius; dv <= gap_radius; ++dv) {
    for (int du = -gap_radius; du <= gap_radius; ++du) {
      const int u = pixel.x() + du;
      const int v = pixel.y() + dv;
      const int point = seen_at(index, u, v);
      if (point < 0) continue;
      const int columns = (du <= 0 ? 1 : 0) | (du >= 0 ? 2 : 0);
      quadrants |= (dv <= 0 ? columns : 0) | (dv >= 0 ? columns << 2 : 0);
      const bool is_inside = u >= box.left && u < box.right && v >= box.top && v < box.bottom;
      const int distance = du * du + dv * dv;
      if (!is_inside || distance >= least) continue;
      nearest = point;
      least = distance;
    }
  }
  return quadrants == 15 ? nearest : -1;
}

std::vector<int> points_on_grid(const PixelIndex& index, int step) {
  std::vector<int> found;
  const int centre = step / 2;
  const PixelWindow& window = index.window;
  for (int top = window.top / step * step; top < window.top + window.height; top += step) {
    for (int left = window.left / step * step; left < window.left + window.width; left += step) {
      const PixelBox mask{left, top, left + step, top + step};
      const int point = point_at(index, {left + centre, top + centre}, mask);
      if (point >= 0) found.push_back(point);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<int> about_as_many_points_on_grid(const PixelIndex& index, int wished) {
  const double guess = std::sqrt(static_cast<double>(index.count) / wished);
  constexpr int near_enough = 20;  // by one in so many: the next step gives a tenth more at least
  std::vector<int> best;
  const auto miss = [&](const std::vector<int>& points) {
    return std::abs(static_cast<int>(points.size()) - wished);
  };
  // Holes and ragged rims make the guess inexact, never by as much as a factor of two.
  for (int step = static_cast<int>(2 * guess) + 1; step >= std::max(1, static_cast<int>(guess / 2)); --step) {
    auto points = points_on_grid(index, step);
    const bool is_past = static_cast<int>(points.size()) >= wished;
    if (best.empty() || miss(points) < miss(best)) best = std::move(points);
    if (is_past || near_enough * miss(best) < wished) break;  // narrower steps give more and more
  }
  return best;
}

}  // namespace pliant
