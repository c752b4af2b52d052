#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "framework/geometry/camera.h"

namespace pliant {

/// The cameras that see a frame, fixed to each other.
struct Rig {
  Camera depth;
  /// The camera of the colour images; absent where they are the depth camera's, pixel for pixel.
  std::optional<Camera> color = std::nullopt;
  /// From the depth camera's frame to the colour camera's, mm; without a colour camera it plays no part.
  Eigen::Isometry3d color_from_depth = Eigen::Isometry3d::Identity();
};

/// Whether a matrix moves without distorting: the upper left 3x3 is a rotation to 1e-3 in every entry of
/// R^T R, as numbers of few digits are, the last row is 0 0 0 1, and all of it is finite.
bool is_rigid(const Eigen::Matrix4d& matrix);

/// Throws DataError, which begins with `name`, unless focal lengths are positive, principal points finite
/// and the motion between the cameras rigid.
void check(const Rig& rig, const std::string& name);

}  // namespace pliant
