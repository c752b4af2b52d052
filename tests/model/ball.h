#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "framework/core/angle.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"

namespace pliant::test {

/// A ball before a wall, mm in the model's frame: what a camera sees of them is known exactly.
struct Ball {
  Eigen::Vector3d centre{5, -8, 600};
  double radius = 80;
  double wall = std::numeric_limits<double>::infinity();  ///< where the plane z = wall lies

  /// Depth of what the ray through a pixel meets first; 0 where that is nothing.
  double depth(const Camera& camera, const Eigen::Isometry3d& camera_from_model, double u, double v) const {
    const Eigen::Isometry3d model_from_camera = camera_from_model.inverse();
    const Eigen::Vector3d from = model_from_camera.translation() - centre;
    const Eigen::Vector3d ray = model_from_camera.linear() * camera.unproject(u, v, 1);
    const double half = from.dot(ray) / ray.squaredNorm();
    const double rest = half * half - (from.squaredNorm() - radius * radius) / ray.squaredNorm();
    const double ball = rest >= 0 ? -half - std::sqrt(rest) : -1;
    if (ball > 0) return ball;
    const double behind = (wall - centre.z() - from.z()) / ray.z();
    return std::isfinite(behind) && behind > 0 ? behind : 0;
  }

  Frame frame(const Camera& camera, const Eigen::Isometry3d& camera_from_model) const {
    Frame frame{DepthImage(camera.width, camera.height), {}, {}};
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
        frame.depth(u, v) = static_cast<float>(depth(camera, camera_from_model, u, v));
    return frame;
  }

  /// A camera that has gone around the ball by some degrees about an axis of the model.
  Eigen::Isometry3d from_around(double degrees, const Eigen::Vector3d& axis) const {
    return Eigen::Translation3d(centre) * Eigen::AngleAxisd(degrees * degree, axis.normalized()) *
           Eigen::Translation3d(-centre);
  }
};

}  // namespace pliant::test
