#pragma once

#include <memory>
#include <string>

#include "framework/device/device.h"
#include "framework/problem/problem.h"

namespace pliant {

/// Words of the status record that a Gauss-Newton solve keeps on the device (32 bits each; F: a float).
enum StatusWord {
  status_skip = 0,       ///< not zero once the solve has ended: every kernel then returns at once
  status_bad_pivot = 1,  ///< set when a step could not be solved for
  status_iterations = 2,
  status_damping = 3,       ///< F: lambda of (J^T J + lambda diag(J^T J)) step = -J^T r
  status_energy = 4,        ///< F
  status_trial_energy = 5,  ///< F
  status_accepted = 6,
  status_termination = 7,        ///< see Termination
  status_initial_energy = 8,     ///< F
  status_linear_iterations = 9,  ///< of iterative linear solvers, all steps together
  status_energies = 16,          ///< F: one per iteration from here on
};

/// Why a solve ended.
enum Termination {
  termination_converged = 1,
  termination_max_iterations = 2,
  termination_no_decrease = 3,  ///< not even the heaviest damping lowered the energy
  termination_not_finite = 4,   ///< the energy is not finite at the start
};

inline constexpr int most_iterations = 200;
inline constexpr std::size_t status_words = status_energies + most_iterations;

struct MinimiserOptions {
  int max_iterations;
  float tolerance;  ///< relative change of the energy that ends the solve
  float damping;    ///< least lambda
};

/// Waits for what is enqueued, and tells whether the solve has ended. Asked after each iteration: the
/// launches of one that finds the solve ended cost more than the wait.
inline bool has_ended(const Device& device, const Buffer& status) {
  cl_int skip = 0;
  device.read(status, &skip, sizeof(skip));
  return skip != 0;
}

/// A Gauss-Newton solve bound to one problem on one device.
class Minimiser {
 public:
  virtual ~Minimiser() = default;
  /// Enqueues a whole solve from problem.unknowns() to problem.unknowns(), and may wait between its
  /// iterations. `status`: status_words zeros, which the minimiser fills.
  virtual void enqueue(const Buffer& status) = 0;
  /// Name of the linear solver and, where it was chosen for the user, why.
  virtual std::string description() const = 0;
};

/// Solves the damped normal equations inside Gauss-Newton, and with that decides how the whole minimisation
/// runs: step by step over an assembled matrix (stepwise.h), or as it likes.
class LinearSolver {
 public:
  static constexpr const char* kind = "linear_solver";
  virtual ~LinearSolver() = default;
  /// `problem` and `device` must outlive what is returned. Throws ConfigError for a problem that this
  /// linear solver cannot serve.
  virtual std::unique_ptr<Minimiser> bind(Problem& problem, Device& device,
                                          const MinimiserOptions& options) const = 0;
};

}  // namespace pliant
