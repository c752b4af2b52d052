#pragma once

#include <Eigen/Core>
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
std::vector<Eigen::Vector3f> unflatten(const Array<float>& values);

}  // namespace pliant
