#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "framework/core/parameters.h"

namespace pliant {

/// Where a camera stands and how it is turned, in the frame of a camera that has not moved (x right, y down,
/// z forward, mm).
struct CameraPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// The point that it looks at, its x axis level; then the orientation follows from it.
  std::optional<Eigen::Vector3d> look_at = std::nullopt;

  /// From the frame of the camera that has not moved to that of this one.
  Eigen::Isometry3d camera_from_scene() const;
};

/// The rows of a section that describes one: either `look_from` and `look_at` (the `middle` of what is seen,
/// where only one is given its fallback: here, and there), or `shift` and `rotation`.
ParameterTable camera_pose_table();

/// Throws ConfigError, which names the section's place, when it mixes the two ways, or looks straight up or
/// down or from where it looks at. `middle`: of what is seen, mm.
CameraPose read_camera_pose(const Parameters& section, const Eigen::Vector3d& middle);

/// `share` of the way: straight, turning at constant speed; between two poses that look at points the camera
/// looks at the point that goes straight from one to the other.
CameraPose between(const CameraPose& from, const CameraPose& to, double share);

/// The rotation by degrees about x, then y, then z.
Eigen::Quaterniond turned(const Eigen::Vector3d& degrees);

}  // namespace pliant
