#include "framework/geometry/surface.h"
#include "framework/geometry/has_point.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace pliant {
namespace {

using PointImage = Image<Eigen::Vector3f>;

template <class Overlay>
void check_same_size(const Overlay& overlay, int width, int height, const char* what) {
  if (!overlay.empty() && (overlay.width() != width || overlay.height() != height)) {
    throw std::invalid_argument(std::string(what) + " and depth differ in size");
  }
}

PointImage make_points(const Frame& frame, const Camera& camera) {
  PointImage points(frame.depth.width(), frame.depth.height(), Eigen::Vector3f::Zero());
  for (int v = 0; v < points.height(); ++v) {
    for (int u = 0; u < points.width(); ++u) {
      if (has_point(frame, u, v)) points(u, v) = camera.unproject(u, v, frame.depth(u, v)).cast<float>();
    }
  }
  return points;
}

/// Sums over the points of a window, relative to its centre so that nothing cancels.
struct Moments {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(const Eigen::Vector3d& p) {
    ++count;
    sum += p;
    xx += p.x() * p.x();
    xy += p.x() * p.y();
    xz += p.x() * p.z();
    yy += p.y() * p.y();
    yz += p.y() * p.z();
    zz += p.z() * p.z();
  }

  Eigen::Matrix3d covariance() const {
    Eigen::Matrix3d second;
    second << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return second / count - (sum / count) * (sum / count).transpose();
  }
};

Moments collect_window(const PointImage& points, int u, int v, int radius, float depth_step) {
  const Eigen::Vector3f& centre = points(u, v);
  const int last_u = std::min(u + radius, points.width() - 1);
  const int last_v = std::min(v + radius, points.height() - 1);
  Moments moments;
  for (int y = std::max(v - radius, 0); y <= last_v; ++y) {
    for (int x = std::max(u - radius, 0); x <= last_u; ++x) {
      const Eigen::Vector3f& point = points(x, y);
      if (is_point(point) && std::abs(point.z() - centre.z()) < depth_step) {
        moments.add((point - centre).cast<double>());
      }
    }
  }
  return moments;
}

/// Unit normal of the plane through the points of a window, zero where they define none.
Eigen::Vector3d fit_normal(const Moments& moments) {
  if (moments.count < fewest_plane_points) return Eigen::Vector3d::Zero();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments.covariance());
  const Eigen::Vector3d& spread = solver.eigenvalues();
  if (spread[1] <= flattest_spread * spread[2]) return Eigen::Vector3d::Zero();
  return solver.eigenvectors().col(0);
}

/// Unit normal at a point, zero where even the widest window gives none.
Eigen::Vector3d find_normal(const PointImage& points, int u, int v, int radius, float depth_step) {
  const Eigen::Vector3d point = points(u, v).cast<double>();
  for (int reach = radius; reach <= std::max(radius, widest_normal_radius); reach *= 2) {
    Eigen::Vector3d normal = fit_normal(collect_window(points, u, v, reach, depth_step));
    if (std::abs(normal.dot(point)) >= edge_on * point.z()) return normal;
  }
  return Eigen::Vector3d::Zero();
}

}  // namespace

SurfaceImage make_surface_image(const Frame& frame, const Camera& camera, int radius, float depth_step) {
  check_same_size(frame.mask, frame.depth.width(), frame.depth.height(), "mask");
  SurfaceImage map{make_points(frame, camera), {}};
  map.normals = PointImage(map.points.width(), map.points.height(), Eigen::Vector3f::Zero());
  for (int v = 0; v < map.points.height(); ++v) {
    for (int u = 0; u < map.points.width(); ++u) {
      const Eigen::Vector3f& point = map.points(u, v);
      if (!is_point(point)) continue;
      const Eigen::Vector3f normal = find_normal(map.points, u, v, radius, depth_step).cast<float>();
      map.normals(u, v) = normal.dot(point) > 0 ? Eigen::Vector3f(-normal) : normal;
    }
  }
  return map;
}

Surface make_surface(const SurfaceImage& map, const ColorImage& color) {
  check_same_size(color, map.points.width(), map.points.height(), "colour");
  Surface surface;
  for (int v = 0; v < map.points.height(); ++v) {
    for (int u = 0; u < map.points.width(); ++u) {
      if (!is_point(map.points(u, v))) continue;
      surface.points.push_back(map.points(u, v));
      surface.normals.push_back(map.normals(u, v));
      surface.pixels.emplace_back(u, v);
      if (!color.empty()) surface.colors.push_back(color(u, v));
    }
  }
  return surface;
}

}  // namespace pliant
