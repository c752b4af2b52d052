#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "framework/core/angle.h"

namespace pliant::test {

/// The angle between two vectors, exact for small ones too.
template <class One, class Other>
double degrees_between(const Eigen::MatrixBase<One>& one, const Eigen::MatrixBase<Other>& other) {
  const Eigen::Vector3d a = one.template cast<double>();
  const Eigen::Vector3d b = other.template cast<double>();
  return std::atan2(a.cross(b).norm(), a.dot(b)) / degree;
}

}  // namespace pliant::test
