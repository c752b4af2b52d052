#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <string_view>

#include "framework/device/device.h"

namespace pliant {

/// What one matching asks for: J^T J and J^T r of the point-to-plane distances [Eq. 3.2] of the accepted
/// matches by a small turn about a pivot (radians), then a shift (mm).
struct RigidEquations {
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< where the middle of the source is moved to, mm
  Eigen::Matrix<double, 6, 6> JtJ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> Jtr = Eigen::Matrix<double, 6, 1>::Zero();
  double squares = 0;  ///< sum of squared distances, mm^2
  int matches = 0;     ///< that are accepted
  int landed = 0;      ///< points whose pixel has a point of the target
  int samples = 0;     ///< all points, where they are counted
};

/// Eigenvalues of J^T J, ascending, turns measured in mm at distance `size` from the pivot.
Eigen::Matrix<double, 6, 1> eigenvalues_of(const RigidEquations& equations, double size);

/// The least of them over the greatest: near 0 where the surface may slide or turn along itself.
double conditioning_of(const Eigen::Matrix<double, 6, 1>& eigenvalues);

/// Numbers that a matching adds up on the device: SUMS in rigid_step.cl.
inline constexpr std::size_t rigid_sums = 32;

/// What they say; the pivot is not among them.
RigidEquations read_equations(const float* sums);

/// The rows of a rotation, then the shift (mm), as kernels take a motion.
cl_float16 values_of(const Eigen::Isometry3d& motion);

/// `source` behind lanes.cl, surface_map.cl, rigid_equation.h and rigid_step.cl, for vectors of that width.
std::string with_rigid_step(int width, std::string_view source);

}  // namespace pliant
