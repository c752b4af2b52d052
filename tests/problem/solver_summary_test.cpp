#include <gmock/gmock.h>

#include "framework/problem/solver.h"

namespace pliant {
namespace {

TEST(SolverSummary, TellsPeopleWhatHappened) {
  const SolverSummary summary{.solver = "gauss_newton",
                              .linear_solver = "dense_cholesky",
                              .initial_energy = 12,
                              .final_energy = 2.5,
                              .energies = {4, 2.5},
                              .iterations = 2,
                              .termination = "converged",
                              .time_ms = {{"mm", 1.25}}};
  const auto report = summary.report();
  EXPECT_THAT(report, testing::HasSubstr(
                          "gauss_newton (dense_cholesky): energy 12 -> 2.5 in 2 iterations, converged\n"));
  EXPECT_THAT(report, testing::ContainsRegex("1 +4\n"));
  EXPECT_THAT(report, testing::ContainsRegex("2 +2.5\n"));
  EXPECT_THAT(report, testing::ContainsRegex("mm +1.250 ms\n"));
}

}  // namespace
}  // namespace pliant
