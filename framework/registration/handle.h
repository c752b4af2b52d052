#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/registry.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Where a surface is taken hold of, and how what is held there is to move.
struct Handle {
  static constexpr const char* kind = "handle";

  std::optional<Eigen::Vector2i> pixel;  ///< holds around the point seen there; none: around `point`
  Eigen::Vector3f point = Eigen::Vector3f::Zero();     ///< mm, camera frame
  float radius = 0;                                    ///< mm
  Eigen::Vector3f move = Eigen::Vector3f::Zero();      ///< mm
  Eigen::Vector3f rotation = Eigen::Vector3f::Zero();  ///< axis times angle (radians), about the place held
  std::string place = {};                              ///< where an experiment names it, for errors
};

/// What a handle holds of a surface.
struct Grip {
  std::vector<int> points;  ///< by index, ascending; at least one
  Eigen::Isometry3f motion = Eigen::Isometry3f::Identity();
};

/// Throws ConfigError, which begins with the handle's place, when the handle meets no point of the surface.
Grip take_hold(const Handle& handle, const Surface& surface);

/// Adds `pixel` and `point`.
void register_handles(Registry& registry);

}  // namespace pliant
