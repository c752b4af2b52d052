#pragma once

#include <memory>
#include <string>

#include "framework/problem/normal_equations.h"

namespace pliant {

/// Words of the status record that a Gauss-Newton solve keeps on the device (32 bits each; F: a float).
enum StatusWord {
  status_skip = 0,       ///< not zero once the solve has ended: every kernel then returns at once
  status_bad_pivot = 1,  ///< set by a linear solver that could not solve
  status_iterations = 2,
  status_damping = 3,       ///< F: lambda of (J^T J + lambda diag(J^T J)) step = -J^T r
  status_energy = 4,        ///< F
  status_trial_energy = 5,  ///< F
  status_accepted = 6,
  status_termination = 7,
  status_initial_energy = 8,  ///< F
  status_energies = 16,       ///< F: one per iteration from here on
};

/// A linear solver bound to the normal equations of one problem.
class BoundLinearSolver {
 public:
  virtual ~BoundLinearSolver() = default;
  /// Enqueues the solution of the damped system into step(); sets status_bad_pivot when there is none.
  virtual void solve(const cl::Buffer& status) = 0;
  /// affine_size floats a node.
  virtual const cl::Buffer& step() const = 0;
};

/// Solves the damped normal equations inside Gauss-Newton.
class LinearSolver {
 public:
  static constexpr const char* kind = "linear_solver";
  virtual ~LinearSolver() = default;
  virtual std::string name() const = 0;
  virtual std::unique_ptr<BoundLinearSolver> bind(NormalEquations& equations) const = 0;
};

}  // namespace pliant
