#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"

namespace pliant::test {

/// A wall that bends along x towards the camera at both sides, mm in the model's frame: what is at (x, y, z)
/// goes to (x, y, z - bend(x)).
struct BendingWall {
  double height = 12;  ///< of the bend at x = 100
  double rest = 620;   ///< the plane z = rest is bent

  double bend(double x) const { return height * x * x / 1e4; }
  double slope(double x) const { return 2 * height * x / 1e4; }

  /// The motion about a node there: columns of R - I, then t.
  Eigen::Matrix<float, 3, 4> form(const Eigen::Vector3f& node) const {
    Eigen::Matrix<float, 3, 4> form = Eigen::Matrix<float, 3, 4>::Zero();
    form(2, 0) = static_cast<float>(-slope(node.x()));
    form(2, 3) = static_cast<float>(-bend(node.x()));
    return form;
  }

  Frame frame(const Camera& camera, const Eigen::Isometry3d& camera_from_model) const {
    Frame frame{DepthImage(camera.width, camera.height), {}, {}};
    const Eigen::Isometry3d model_from_camera = camera_from_model.inverse();
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        double depth = rest;
        for (int round = 0; round < 30; ++round) {
          const Eigen::Vector3d p = model_from_camera * camera.unproject(u, v, depth);
          depth -= p.z() - (rest - bend(p.x()));
        }
        frame.depth(u, v) = static_cast<float>(depth);
      }
    return frame;
  }

  /// How far a point is from it, along z.
  double error(const Eigen::Vector3d& p) const { return std::abs(p.z() - (rest - bend(p.x()))); }
};

}  // namespace pliant::test
