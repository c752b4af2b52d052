#include "framework/segmentation/window_at_depth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "framework/geometry/has_point.h"
#include "framework/segmentation/parts.h"

namespace pliant {
namespace {

/// A depth pixel as the colour camera sees its point.
struct Projected {
  int u = 0;  ///< in the depth image
  int v = 0;
  Eigen::Vector2d pixel;  ///< in the colour image
  double depth = 0;       ///< mm, in the colour camera's frame
};

/// Whether a pixel lies in the middle of a window: in so large a share of its width and height.
bool is_in(const PixelWindow& window, const Eigen::Vector2d& pixel, double share = 1) {
  const Eigen::Array2d size(window.width, window.height);
  const Eigen::Array2d middle = Eigen::Array2d(window.left, window.top) + (size - 1) / 2;
  return ((pixel.array() - middle).abs() <= share * size / 2).all();
}

std::vector<Projected> points_in(const PixelWindow& window, const Frame& frame, const Rig& rig) {
  const bool is_apart = rig.color.has_value();
  const Camera& camera = is_apart ? *rig.color : rig.depth;
  const Eigen::Isometry3d motion = is_apart ? rig.color_from_depth : Eigen::Isometry3d::Identity();
  std::vector<Projected> points;
  for (int v = 0; v < frame.depth.height(); ++v) {
    for (int u = 0; u < frame.depth.width(); ++u) {
      if (!has_point(frame, u, v)) continue;
      const Eigen::Vector3d point = motion * rig.depth.unproject(u, v, frame.depth(u, v));
      if (!(point.z() > 0)) continue;
      const Eigen::Vector2d pixel = camera.project(point);
      if (is_in(window, pixel)) points.push_back({u, v, pixel, point.z()});
    }
  }
  return points;
}

std::optional<double> middle_depth(const std::vector<Projected>& points, const PixelWindow& window) {
  constexpr double middle_half = 0.5;
  std::vector<double> depths;
  for (const Projected& point : points)
    if (is_in(window, point.pixel, middle_half)) depths.push_back(point.depth);
  if (depths.empty()) return std::nullopt;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return *middle;
}

}  // namespace

std::optional<PixelWindow> window_at_depth(const PixelWindow& color_window, const Frame& frame,
                                           const Rig& rig, double depth_band, int speck) {
  const std::vector<Projected> points = points_in(color_window, frame, rig);
  const auto middle = middle_depth(points, color_window);
  if (!middle) return std::nullopt;
  MaskImage shown(frame.depth.width(), frame.depth.height());
  for (const Projected& point : points)
    if (std::abs(point.depth - *middle) <= depth_band) shown(point.u, point.v) = 1;
  return window_of_parts(shown, speck);
}

}  // namespace pliant
