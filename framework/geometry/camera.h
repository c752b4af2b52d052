#pragma once

#include <Eigen/Core>

namespace pliant {

/// Pinhole camera without distortion. Camera frame: x right, y down, z forward, millimetres.
struct Camera {
  double fx = 0;  ///< focal lengths and principal point in pixels
  double fy = 0;
  double cx = 0;
  double cy = 0;
  int width = 0;
  int height = 0;

  Eigen::Vector3d unproject(double u, double v, double depth) const {
    return {(u - cx) / fx * depth, (v - cy) / fy * depth, depth};
  }
  /// Pixel of a point in front of the camera (z > 0).
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }
};

}  // namespace pliant
