#include "framework/geometry/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pliant {
namespace {

/// The pixels whose rays may meet a triangle: columns [first_u, last_u] of rows [first_v, last_v].
struct PixelBox {
  int first_u = 0;
  int last_u = -1;
  int first_v = 0;
  int last_v = -1;
};

/// Three corners of a triangle, one a column.
using Corners = Eigen::Matrix3d;

/// The box around the part of a triangle that is at `near` or farther.
PixelBox pixel_box(const Corners& corners, const Camera& camera, double near) {
  // Rounding must not push a pixel whose ray just touches the triangle out of the box.
  constexpr double kMargin = 1e-6;
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  const auto add = [&](const Eigen::Vector3d& point) {
    const Eigen::Array2d pixel = camera.project(point).array();
    low = low.min(pixel);
    high = high.max(pixel);
  };
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = corners.col(i);
    const Eigen::Vector3d& b = corners.col((i + 1) % 3);
    if (a.z() >= near) add(a);
    if ((a.z() >= near) != (b.z() >= near)) add(a + (near - a.z()) / (b.z() - a.z()) * (b - a));
  }
  // Compared as real numbers: a corner beside the camera projects further out than an int reaches.
  const auto first = [](double value) { return static_cast<int>(std::ceil(std::max(value - kMargin, 0.0))); };
  const auto last = [](double value, int size) {
    return static_cast<int>(std::floor(std::min(value + kMargin, size - 1.0)));
  };
  if (!(low.x() < camera.width && low.y() < camera.height && high.x() > -1 && high.y() > -1)) return {};
  return {first(low.x()), last(high.x(), camera.width), first(low.y()), last(high.y(), camera.height)};
}

/// Draws one triangle. The ray d meets its plane at barycentric coordinates that are proportional to
/// (d . (p1 x p2), d . (p2 x p0), d . (p0 x p1)), which holds for corners behind the camera too.
void draw(int index, const Corners& corners, const Camera& camera, double near, Image<Fragment>& seen) {
  // A ray closer to an edge than rounding can tell is on it, for both triangles of the edge: through a
  // vertex it could otherwise pass between all of them.
  constexpr double kRounding = 1e-14;
  Eigen::Matrix3d planes;
  Eigen::Vector3d rounding;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& a = corners.col((i + 1) % 3);
    const Eigen::Vector3d& b = corners.col((i + 2) % 3);
    planes.row(i) = a.cross(b).transpose();
    rounding[i] = kRounding * a.norm() * b.norm();
  }
  // Negative for a triangle seen from outside.
  const double volume = planes.row(0).dot(corners.col(0));
  if (volume < 0) planes = -planes;
  const PixelBox box = pixel_box(corners, camera, near);
  for (int v = box.first_v; v <= box.last_v; ++v) {
    for (int u = box.first_u; u <= box.last_u; ++u) {
      const Eigen::Vector3d ray = camera.unproject(u, v, 1);
      const Eigen::Array3d tolerance = rounding.array() * ray.norm();
      const Eigen::Array3d shares = planes * ray;
      // A triangle whose plane the ray lies in is seen from its edge, and its neighbours are seen instead.
      if ((shares < -tolerance).any() || !(shares.sum() > tolerance.sum())) continue;
      const Eigen::Vector3d barycentric = shares.max(0) / shares.max(0).sum();
      const double depth = corners.row(2).dot(barycentric);
      Fragment& fragment = seen(u, v);
      if (depth < near || (fragment.triangle >= 0 && depth >= fragment.depth)) continue;
      fragment = {index, barycentric, depth};
    }
  }
}

}  // namespace

Image<Fragment> render_mesh(const std::vector<Eigen::Vector3d>& vertices,
                            const std::vector<Eigen::Vector3i>& triangles, const Camera& camera,
                            double near) {
  Image<Fragment> seen(camera.width, camera.height);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Corners corners;
    for (int i = 0; i < 3; ++i) {
      const int vertex = triangles[t][i];
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices.size()) {
        throw std::invalid_argument("a triangle names a vertex that does not exist");
      }
      corners.col(i) = vertices[static_cast<std::size_t>(vertex)];
    }
    if (corners.allFinite()) draw(static_cast<int>(t), corners, camera, near, seen);
  }
  return seen;
}

DepthImage depth_of(const Image<Fragment>& seen) {
  DepthImage depth(seen.width(), seen.height());
  std::transform(seen.data(), seen.data() + seen.size(), depth.data(),
                 [](const Fragment& fragment) { return static_cast<float>(fragment.depth); });
  return depth;
}

Eigen::Vector3d interpolate(const Fragment& fragment, const std::vector<Eigen::Vector3i>& triangles,
                            const std::vector<Eigen::Vector3d>& values) {
  const Eigen::Vector3i& triangle = triangles[static_cast<std::size_t>(fragment.triangle)];
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    value += fragment.barycentric[i] * values[static_cast<std::size_t>(triangle[i])];
  return value;
}

Image<Eigen::Vector3f> scene_flow(const Image<Fragment>& seen, const std::vector<Eigen::Vector3i>& triangles,
                                  const std::vector<Eigen::Vector3d>& from,
                                  const std::vector<Eigen::Vector3d>& to) {
  const auto unknown = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  Image<Eigen::Vector3f> flow(seen.width(), seen.height(), unknown);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Fragment& fragment = seen.data()[i];
    if (fragment.triangle < 0) continue;
    flow.data()[i] =
        (interpolate(fragment, triangles, to) - interpolate(fragment, triangles, from)).cast<float>();
  }
  return flow;
}

}  // namespace pliant
