#include "framework/geometry/color_at_depth.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "framework/geometry/render.h"
#include "framework/geometry/surface.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Of each depth pixel, in the colour camera's frame; (0, 0, 0) without depth.
Points points_of(const DepthImage& depth, const Rig& rig) {
  Points points(depth.size(), Eigen::Vector3d::Zero());
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      if (is_depth(depth(u, v)))
        points[static_cast<std::size_t>(v) * depth.width() + u] =
            rig.color_from_depth * rig.depth.unproject(u, v, depth(u, v));
  return points;
}

/// Whether three pixels see one surface.
bool is_connected(const DepthImage& depth, const Eigen::Vector3i& pixels) {
  const auto of = [&](int corner) { return depth.data()[pixels[corner]]; };
  if (!is_depth(of(0)) || !is_depth(of(1)) || !is_depth(of(2))) return false;
  return std::max({of(0), of(1), of(2)}) - std::min({of(0), of(1), of(2)}) < default_depth_step;
}

/// Of a point: a bit for each side of a window of an image that its pixel lies beyond. What has one in common
/// for all corners does not meet the window.
std::uint8_t sides_beyond(const Eigen::Vector3d& point, const Camera& camera, const PixelWindow& window) {
  if (!(point.z() > 0)) return 0;  // it may be on any side
  const Eigen::Vector2d pixel = camera.project(point);
  const auto bits = (pixel.x() < window.left ? 1U : 0U) | (pixel.x() > window.left + window.width ? 2U : 0U) |
                    (pixel.y() < window.top ? 4U : 0U) | (pixel.y() > window.top + window.height ? 8U : 0U);
  return static_cast<std::uint8_t>(bits);
}

/// Two between each four neighbours that are connected; their corners are offsets of pixels. Without those
/// whose corners are all beyond one side.
std::vector<Eigen::Vector3i> triangles_of(const DepthImage& depth, const std::vector<std::uint8_t>& beyond) {
  std::vector<Eigen::Vector3i> triangles;
  const auto is_beyond = [&](const Eigen::Vector3i& corners) {
    return (beyond[static_cast<std::size_t>(corners[0])] & beyond[static_cast<std::size_t>(corners[1])] &
            beyond[static_cast<std::size_t>(corners[2])]) != 0;
  };
  const int width = depth.width();
  for (int v = 0; v + 1 < depth.height(); ++v) {
    for (int u = 0; u + 1 < width; ++u) {
      const int corner = v * width + u;
      for (const Eigen::Vector3i& triangle :
           {Eigen::Vector3i(corner, corner + width, corner + 1),
            Eigen::Vector3i(corner + 1, corner + width, corner + width + 1)})
        if (!is_beyond(triangle) && is_connected(depth, triangle)) triangles.push_back(triangle);
    }
  }
  return triangles;
}

/// The part of a camera's image in a window as a camera.
Camera cropped(const Camera& camera, const PixelWindow& window) {
  return {camera.fx, camera.fy, camera.cx - window.left, camera.cy - window.top, window.width, window.height};
}

/// `points`: those of `depth` in the frame of the colour camera.
DepthImage seen_in(const PixelWindow& window, const Points& points, const DepthImage& depth,
                   const Camera& camera) {
  std::vector<std::uint8_t> beyond(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) beyond[i] = sides_beyond(points[i], camera, window);
  const DepthImage seen = depth_of(render_mesh(points, triangles_of(depth, beyond), cropped(camera, window)));
  DepthImage whole(camera.width, camera.height);
  for (int v = 0; v < window.height; ++v)
    std::copy_n(&seen(0, v), window.width, &whole(window.left, window.top + v));
  return whole;
}

/// The pixel of the colour image that shows a point (mm, colour camera's frame), where one does. `nearest`:
/// the depth that the colour camera would see, 0 where it sees none.
std::optional<Eigen::Vector2i> shown_at(const Eigen::Vector3d& point, const Camera& camera,
                                        const DepthImage& nearest) {
  if (!(point.z() > 0)) return std::nullopt;
  const Eigen::Array2d pixel = camera.project(point).array().round();
  // Compared as real numbers: a point beside the camera projects further out than an int reaches.
  if (!(pixel >= 0).all() || !(pixel < Eigen::Array2d(camera.width, camera.height)).all())
    return std::nullopt;
  const Eigen::Vector2i found = pixel.cast<int>();
  const float front = nearest(found.x(), found.y());
  if (front > 0 && point.z() - front >= default_depth_step) return std::nullopt;
  return found;
}

}  // namespace

DepthImage depth_at_color(const DepthImage& depth, const Rig& rig, const PixelWindow& window) {
  if (!rig.color) return depth;
  return seen_in(window, points_of(depth, rig), depth, *rig.color);
}

ColorImage color_at_depth(const Frame& frame, const Rig& rig) {
  if (!rig.color || frame.color.empty()) return frame.color;
  const Points points = points_of(frame.depth, rig);
  const DepthImage nearest = seen_in(whole_image(*rig.color), points, frame.depth, *rig.color);
  ColorImage color(frame.depth.width(), frame.depth.height());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const auto pixel = shown_at(points[i], *rig.color, nearest))
      color.data()[i] = frame.color(pixel->x(), pixel->y());
  return color;
}

}  // namespace pliant
