#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/device/device.h"
#include "framework/problem/problem.h"

namespace pliant {

/// What one solve came to.
struct SolverSummary {
  std::string solver;
  std::string linear_solver;
  double initial_energy = 0;
  double final_energy = 0;
  std::vector<double> energies;  ///< after each iteration, rejected steps included (the energy stays)
  int iterations = 0;
  int linear_iterations = 0;  ///< of an iterative linear solver, over all iterations
  std::string termination;    ///< "converged", "max_iterations", "no_decrease" or "failed"
  std::string failure = {};   ///< why it "failed"; the unknowns are as they were then
  StageTimes time_ms;         ///< host stages; device stages are recorded by the Device

  /// A few lines for people.
  std::string report() const;
};

/// A solver bound to one problem, whose graph, edges and influences stay as they are. The problem's
/// start, targets, confidences, weights and scales of losses may change between solves.
class BoundSolver {
 public:
  virtual ~BoundSolver() = default;
  /// Minimises from problem.unknowns() and leaves the solution there. A device solver enqueues, and waits
  /// only for the solve before and between iterations, to launch none in vain; not for the last.
  virtual void solve() = 0;
  /// Waits, and tells of every solve since binding.
  virtual std::vector<SolverSummary> summaries() = 0;
};

/// A method to minimise E_tot.
class Solver {
 public:
  static constexpr const char* kind = "solver";
  virtual ~Solver() = default;
  /// `problem` and `device` must outlive what is returned.
  virtual std::unique_ptr<BoundSolver> bind(Problem& problem, Device& device) const = 0;
};

}  // namespace pliant
