#include "framework/geometry/true_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace pliant {
namespace {

/// The depth at which the ray through a pixel meets the plane of the point, as far as it is to be trusted.
double depth_on_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double reach,
                      const Eigen::Vector3d& ray) {
  const double on_plane = normal.dot(point) / normal.dot(ray);
  return std::fmin(std::fmax(on_plane, point.z() - reach), point.z() + reach);
}

}  // namespace

bool is_shown(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const Camera& camera,
              const DepthImage& depth) {
  const Eigen::Vector2d at = camera.project(point);
  const double pixel_u = std::nearbyint(at.x());
  const double pixel_v = std::nearbyint(at.y());
  const bool is_inside = pixel_u >= 0 && pixel_v >= 0 && pixel_u < depth.width() && pixel_v < depth.height();
  if (!is_inside) return false;
  const auto first_u = static_cast<int>(std::floor(at.x()));
  const auto first_v = static_cast<int>(std::floor(at.y()));
  const double footprint = point.z() / std::min(camera.fx, camera.fy);
  const double tolerance = nearest_hiding + hiding_pixels * footprint;
  for (int v = std::max(first_v, 0); v <= std::min(first_v + 1, depth.height() - 1); ++v) {
    for (int u = std::max(first_u, 0); u <= std::min(first_u + 1, depth.width() - 1); ++u) {
      const double expected =
          depth_on_plane(point, normal, steepest_hiding_slope * footprint, camera.unproject(u, v, 1));
      const double shown = depth(u, v);
      if (shown > 0 && shown < expected - tolerance) return false;
      const bool is_its_pixel = u == static_cast<int>(pixel_u) && v == static_cast<int>(pixel_v);
      if (is_its_pixel && !(shown > 0 && shown < expected + tolerance)) return false;
    }
  }
  return true;
}

TrueMotion true_motion(const Image<Fragment>& seen, const std::vector<Eigen::Vector3i>& triangles,
                       const Camera& from_camera, const std::vector<Eigen::Vector3d>& to,
                       const Camera& to_camera, const DepthImage& target) {
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  TrueMotion motion{Image<Eigen::Vector3f>(seen.width(), seen.height(), Eigen::Vector3f::Constant(unknown)),
                    Image<Eigen::Vector2f>(seen.width(), seen.height(), Eigen::Vector2f::Constant(unknown)),
                    MaskImage(seen.width(), seen.height(), 0)};
  for (int v = 0; v < seen.height(); ++v) {
    for (int u = 0; u < seen.width(); ++u) {
      const Fragment& fragment = seen(u, v);
      if (fragment.triangle < 0) continue;
      const Eigen::Vector3d moved = interpolate(fragment, triangles, to);
      motion.scene_flow(u, v) = (moved - from_camera.unproject(u, v, fragment.depth)).cast<float>();
      if (moved.z() <= 0) continue;
      motion.optical_flow(u, v) = (to_camera.project(moved) - Eigen::Vector2d(u, v)).cast<float>();
      const Eigen::Vector3i& corners = triangles[static_cast<std::size_t>(fragment.triangle)];
      const auto corner = [&](int i) { return to[static_cast<std::size_t>(corners[i])]; };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      motion.visible(u, v) = is_shown(moved, normal, to_camera, target) ? 1 : 0;
    }
  }
  return motion;
}

}  // namespace pliant
