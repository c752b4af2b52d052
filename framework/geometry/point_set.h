#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/device/array.h"

namespace pliant {

/// Points (mm) and unit normals ((0, 0, 0) where there is none), x y z each.
struct PointSet {
  Array<float> points;
  Array<float> normals;
};

/// Vectors as x y z in turn, and back. Reading vectors that a device wrote waits for it.
Array<float> flatten(const std::vector<Eigen::Vector3f>& vectors);
Array<float> flatten(const std::vector<Eigen::Vector3d>& vectors);
std::vector<Eigen::Vector3f> unflatten(const Array<float>& values);

/// The points of a set, or of a map, at some indices, moved rigidly. Only enqueues.
PointSet pick_points(Device& device, const PointSet& set, const Array<int>& indices,
                     const Eigen::Isometry3d& motion = Eigen::Isometry3d::Identity());

}  // namespace pliant
