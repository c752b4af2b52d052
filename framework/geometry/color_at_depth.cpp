#include "framework/geometry/color_at_depth.h"

#include <algorithm>
#include <array>
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

/// Two between each four neighbours that are connected; their corners are offsets of pixels.
std::vector<Eigen::Vector3i> triangles_of(const DepthImage& depth) {
  std::vector<Eigen::Vector3i> triangles;
  const int width = depth.width();
  for (int v = 0; v + 1 < depth.height(); ++v) {
    for (int u = 0; u + 1 < width; ++u) {
      const int corner = v * width + u;
      for (const Eigen::Vector3i& triangle :
           {Eigen::Vector3i(corner, corner + width, corner + 1),
            Eigen::Vector3i(corner + 1, corner + width, corner + width + 1)})
        if (is_connected(depth, triangle)) triangles.push_back(triangle);
    }
  }
  return triangles;
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

DepthImage depth_at_color(const DepthImage& depth, const Rig& rig) {
  if (!rig.color) return depth;
  return depth_of(render_mesh(points_of(depth, rig), triangles_of(depth), *rig.color));
}

ColorImage color_at_depth(const Frame& frame, const Rig& rig) {
  if (!rig.color || frame.color.empty()) return frame.color;
  const Points points = points_of(frame.depth, rig);
  const DepthImage nearest = depth_at_color(frame.depth, rig);
  ColorImage color(frame.depth.width(), frame.depth.height());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const auto pixel = shown_at(points[i], *rig.color, nearest))
      color.data()[i] = frame.color(pixel->x(), pixel->y());
  return color;
}

}  // namespace pliant
