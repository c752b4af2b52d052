#pragma once

#include <Eigen/Core>

#include "framework/problem/normal_equations.h"
#include "framework/problem/problem.h"

namespace pliant::test {

/// A full J^T J and J^T r.
struct DenseNormals {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
};

/// Built in double on the host, instance by instance from the equations, then along the steps of the
/// transform.
DenseNormals dense_normals(const Problem& problem);

/// What the device assembles at the problem's unknowns, the blocks put in their places (stride numbers a
/// node).
DenseNormals device_normals(NormalEquations& equations);

/// The sum of the partial energies of the device at the problem's unknowns.
double device_energy(NormalEquations& equations, const Problem& problem);

/// A status record of zeros: nothing is skipped.
Buffer make_status(Device& device);

}  // namespace pliant::test
