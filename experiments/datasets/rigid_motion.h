#pragma once

#include <Eigen/Geometry>

#include "framework/core/parameters.h"

namespace pliant {

/// How a thing turns about its middle and then shifts, in a camera's frame.
struct RigidMotion {
  double rotation_x = 0;                            ///< degrees, about the camera's x axis
  double rotation_y = 0;                            ///< degrees, about its y axis, before
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< mm

  Eigen::Isometry3d transform() const;  ///< about the origin
};

/// The rows of a section that describes one, and what it says.
ParameterTable motion_table();
RigidMotion read_motion(const Parameters& section);

/// `share` of the way from one motion to another.
RigidMotion between(const RigidMotion& from, const RigidMotion& to, double share);

}  // namespace pliant
