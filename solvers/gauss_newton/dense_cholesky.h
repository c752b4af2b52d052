#pragma once

#include <memory>

#include "framework/core/registry.h"
#include "solvers/gauss_newton/stepwise.h"

namespace pliant {

/// Adds the linear solver `dense_cholesky` [thesis 4.6]: blocked L L^T and triangular solves in kernels of
/// our own, single precision. Memory grows with the square of the unknowns.
void register_dense_cholesky(Registry& registry);

/// The part of it that solves one assembled system. `equations` must outlive it.
std::unique_ptr<StepSolver> make_dense_cholesky_steps(NormalEquations& equations);

}  // namespace pliant
