#pragma once

#include <Eigen/Core>

#include "framework/problem/problem.h"

namespace pliant::test {

/// What the linear solver `structured` does, iteration by iteration, in double and over the full matrix:
/// damped Gauss-Newton, each step by conjugate gradients that block Jacobi preconditions
/// (docs/structured-solver.md). Unknown 4 axis + c of a node, as its kernels have them.
class ReferenceMinimiser {
 public:
  /// Starts where `problem`, which it moves, stands.
  ReferenceMinimiser(Problem& problem, int max_iterations, double tolerance, double least_damping);

  /// One iteration, unless the minimisation has ended.
  void iterate();

  int termination() const { return termination_; }  ///< 0 while it has not ended, else see Termination
  int iterations() const { return iterations_; }
  int linear_iterations() const { return linear_iterations_; }
  double energy() const { return energy_; }
  /// In the kernels' order.
  Eigen::VectorXd unknowns() const;

 private:
  struct LinearSystem;
  double try_step(const Eigen::VectorXd& step);
  void judge(double change, double threshold, double noise);

  Problem& problem_;
  int max_iterations_;
  double tolerance_, least_damping_;
  double energy_, initial_energy_, summed_energy_, damping_;
  Eigen::VectorXd summed_at_;  ///< where the device last summed its gradient over the instances
  bool fresh_ = true;          ///< it has just done so
  int most_cg_iterations_ = 0;
  int iterations_ = 0, linear_iterations_ = 0, termination_ = 0;
};

}  // namespace pliant::test
