#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "framework/problem/solver.h"
#include "tests/problem/sheet_problem.h"

namespace pliant::test {

/// Every solver and energy there is, and a device.
class SolverTest : public testing::Test {
 protected:
  SolverTest();

  /// Every registered solver, with every choice of its linear solver and `options` of both.
  std::vector<std::string> all_solvers(
      const std::string& options = "tolerance: 1e-8, max_iterations: 200") const;

  /// Solves `problem` from where it stands with the solver written as `yaml`.
  SolverSummary solve(Problem& problem, const std::string& yaml) { return solve(problem, yaml, device_); }
  SolverSummary solve(Problem& problem, const std::string& yaml, Device& device) const;

  Problem sheet_problem(const Sheet& sheet) const { return make_sheet_problem(sheet, energies_); }

  Registry registry_;
  std::vector<Energy> energies_;
  Device device_;
};

bool all_finite(const std::vector<float>& values);

}  // namespace pliant::test
