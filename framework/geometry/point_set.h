#pragma once

#include <Eigen/Geometry>
#include <cstddef>
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

/// Puts points and normals at some indices of `into`; the rest of it stays. Only enqueues.
void place_points(Device& device, const PointSet& set, const Array<int>& indices, PointSet& into);

/// All points of a set, or of a map, moved rigidly, into a set of the same size; (0, 0, 0), no point, stays
/// so. Only enqueues.
void move_points(Device& device, const PointSet& set, const Eigen::Isometry3d& motion, PointSet& into);

/// `count` times no point and no normal.
PointSet no_points(Device& device, std::size_t count);

/// Which of a set, or of a map, are points: indices, ascending. Waits for the device.
std::vector<int> indices_of_points(Device& device, const PointSet& set);

}  // namespace pliant
