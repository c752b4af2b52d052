#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "framework/core/angle.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"

// A lumpy ellipsoid, seen by a camera before and after a rigid motion.
namespace pliant::test {

inline const Camera camera{260, 260, 79.5, 59.5, 160, 120};
/// A function, because constants of the tests are made from it: a variable might be made after them.
inline Eigen::Vector3d middle() { return {0, 0, 600}; }

/// Where the viewing ray of a pixel first meets the object, none where it does not. The object has three
/// unlike axes and lumps, so that no turn maps it onto itself.
inline double inside(const Eigen::Vector3d& p) {
  const Eigen::Vector3d scaled = p.cwiseQuotient(Eigen::Vector3d(75, 100, 85));
  return scaled.norm() - 1 - 0.06 * std::sin(0.06 * p.x() + 1) * std::cos(0.05 * p.y()) -
         0.05 * std::sin(0.045 * p.y() + 0.04 * p.z());
}

inline Frame seen(const Eigen::Isometry3d& motion, const Camera& by = camera) {
  Frame frame{DepthImage(by.width, by.height), {}, {}};
  const Eigen::Isometry3d back = Eigen::Translation3d(-middle()) * motion.inverse();
  for (int v = 0; v < by.height; ++v) {
    for (int u = 0; u < by.width; ++u) {
      const Eigen::Vector3d ray = by.unproject(u, v, 1);
      double depth = 300;
      // The field falls by at most a sixtieth a millimetre: so long a step stays before the surface.
      for (double value = 1; depth < 1000; depth += std::max(40 * value, 0.01)) {
        value = inside(back * (depth * ray));
        if (value < 1e-4) break;
      }
      if (depth < 1000) frame.depth(u, v) = static_cast<float>(depth);
    }
  }
  return frame;
}

/// A plane in the columns from .. to - 1, with a margin above and below, whose depth (mm) grows by `slope` mm
/// a mm to the right.
inline Frame plane(double depth, int from, int to, double slope = 0) {
  Frame frame{DepthImage(camera.width, camera.height), {}, {}};
  for (int v = 20; v < 100; ++v)
    for (int u = from; u < to; ++u)
      frame.depth(u, v) = static_cast<float>(depth / (1 - slope * (u - camera.cx) / camera.fx));
  return frame;
}

inline const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();

inline Eigen::Isometry3d motion_of(double x, double y, double z, const Eigen::Vector3d& shift) {
  return Eigen::Translation3d(middle() + shift) * Eigen::AngleAxisd(x * degree, Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(y * degree, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(z * degree, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(-middle());
}

/// Greatest distance between where two motions take the corners of a box around the object, mm.
inline double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  double worst = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p =
        middle() + 80 * Eigen::Vector3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    worst = std::max(worst, (a * p - b * p).norm());
  }
  return worst;
}

}  // namespace pliant::test
