#pragma once

#include <functional>
#include <memory>
#include <string>

#include "framework/problem/normal_equations.h"
#include "solvers/gauss_newton/linear_solver.h"

namespace pliant {

/// Solves one assembled system after another.
class StepSolver {
 public:
  virtual ~StepSolver() = default;
  /// Enqueues the solution of the damped system into step(); sets status_bad_pivot when there is none.
  virtual void solve(const Buffer& status) = 0;
  /// As many floats a node as the equations' stride.
  virtual const Buffer& step() const = 0;
};
using MakeStepSolver = std::function<std::unique_ptr<StepSolver>(NormalEquations&)>;

/// Gauss-Newton over assembled blocks, kernel by kernel: for any energy and transform.
std::unique_ptr<Minimiser> make_stepwise_minimiser(Problem& problem, Device& device,
                                                   const MinimiserOptions& options,
                                                   const std::string& linear_solver,
                                                   const MakeStepSolver& make);

}  // namespace pliant
