#include "framework/pose/rigid_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "framework/geometry/surface_map.h"
#include "framework/pose/rigid_equation.h.embed.h"
#include "framework/pose/rigid_step.cl.embed.h"
#include "framework/problem/equation_source.h"

namespace pliant {

Eigen::Matrix<double, 6, 1> eigenvalues_of(const RigidEquations& equations, double size) {
  Eigen::Matrix<double, 6, 6> JtJ = equations.JtJ;
  JtJ.topRows<3>() /= size;
  JtJ.leftCols<3>() /= size;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(JtJ, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

double conditioning_of(const Eigen::Matrix<double, 6, 1>& eigenvalues) {
  return eigenvalues[5] > 0 ? std::max(eigenvalues[0], 0.0) / eigenvalues[5] : 0;
}

RigidEquations read_equations(const float* sums) {
  RigidEquations equations;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) equations.JtJ(i, j) = equations.JtJ(j, i) = *sums++;
  for (int i = 0; i < 6; ++i) equations.Jtr[i] = *sums++;
  equations.squares = *sums++;
  equations.matches = static_cast<int>(*sums++);
  equations.landed = static_cast<int>(*sums++);
  equations.samples = static_cast<int>(*sums);
  return equations;
}

cl_float16 values_of(const Eigen::Isometry3d& motion) {
  cl_float16 values{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      values.s[3 * row + column] = static_cast<float>(motion.linear()(row, column));
    values.s[9 + row] = static_cast<float>(motion.translation()[row]);
  }
  return values;
}

std::string with_rigid_step(int width, std::string_view source) {
  const std::string real = width == 1 ? "float" : "float16";
  return with_surface_map(as_opencl(embedded::framework_pose_rigid_equation_h, real) +
                          std::string(embedded::framework_pose_rigid_step_cl) + std::string(source));
}

}  // namespace pliant
