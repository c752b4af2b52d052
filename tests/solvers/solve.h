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

  /// Solves `problem` from where it stands with the solver written as `yaml`.
  SolverSummary solve(Problem& problem, const std::string& yaml);

  Problem sheet_problem(const Sheet& sheet) const { return make_sheet_problem(sheet, energies_); }

  Registry registry_;
  std::vector<Energy> energies_;
  Device device_;
};

bool all_finite(const std::vector<float>& values);

}  // namespace pliant::test
