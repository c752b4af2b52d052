#include <gmock/gmock.h>

#include <limits>

#include "tests/problem/components.h"
#include "tests/solvers/solve.h"

namespace pliant::test {
namespace {

using CeresLm = SolverTest;

TEST_F(CeresLm, TellsOfItsSolve) {
  auto problem = sheet_problem({});
  const double before = problem.energy();
  const auto summary = solve(problem, "{type: ceres_lm, linear_solver: dense_normal_cholesky}");
  EXPECT_EQ(summary.solver, "ceres_lm");
  EXPECT_EQ(summary.linear_solver, "dense_normal_cholesky");
  EXPECT_EQ(summary.termination, "converged");
  EXPECT_NEAR(summary.initial_energy, before, 1e-9 * before);
  EXPECT_NEAR(summary.final_energy, problem.energy(), 1e-4 * summary.final_energy);
  ASSERT_EQ(summary.energies.size(), static_cast<std::size_t>(summary.iterations));
  EXPECT_EQ(summary.energies.back(), summary.final_energy);
  for (const char* stage : {"jacobian", "solver", "energy"}) EXPECT_GT(summary.time_ms.at(stage), 0) << stage;
}

TEST_F(CeresLm, StopsAtTheMostIterations) {
  auto problem = sheet_problem({});
  const auto summary = solve(problem, "{type: ceres_lm, max_iterations: 2, tolerance: 0}");
  EXPECT_EQ(summary.iterations, 2);
  EXPECT_EQ(summary.termination, "max_iterations");
}

TEST_F(CeresLm, ARejectedStepLeavesTheEnergy) {
  int rejected = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    auto problem = sheet_problem({.nodes = 20, .constraints = 100, .relief = 0, .seed = seed});
    randomise_unknowns(problem, 1.5, 100, seed);
    const auto summary = solve(problem, "{type: ceres_lm}");
    double last = summary.initial_energy;
    for (const double energy : summary.energies) {
      EXPECT_LE(energy, last);
      if (energy == last) ++rejected;
      last = energy;
    }
    EXPECT_EQ(summary.final_energy, last);
  }
  EXPECT_GT(rejected, 0) << "these starts were chosen because some step is rejected";
}

TEST_F(CeresLm, AStartThatIsNotFiniteFailsAndChangesNothing) {
  auto problem = sheet_problem({});
  problem.unknowns().write_host()[5] = std::numeric_limits<float>::quiet_NaN();
  const auto summary = solve(problem, "{type: ceres_lm}");
  EXPECT_EQ(summary.termination, "failed");
  EXPECT_THAT(summary.failure, testing::HasSubstr("Ceres"));
  EXPECT_EQ(problem.unknowns().host()[4], 0);
}

TEST_F(CeresLm, SolvesAgainFromWhereItStands) {
  auto problem = sheet_problem({});
  const auto solver = make<Solver>(registry_, "{type: ceres_lm}");
  const auto bound = solver->bind(problem, device_);
  bound->solve();
  bound->solve();
  const auto summaries = bound->summaries();
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_NEAR(summaries[1].initial_energy, summaries[0].final_energy, 1e-4 * summaries[0].final_energy);
  EXPECT_LE(summaries[1].iterations, 2);
}

}  // namespace
}  // namespace pliant::test
