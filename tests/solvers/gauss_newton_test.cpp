#include <gmock/gmock.h>

#include <limits>

#include "tests/problem/components.h"
#include "tests/solvers/solve.h"

namespace pliant::test {
namespace {

/// What holds for Gauss-Newton whatever solves for its steps.
class GaussNewton : public SolverTest, public testing::WithParamInterface<std::string> {
 protected:
  /// `more`: further parameters, e.g. ", tolerance: 0".
  std::string solver(const std::string& more = "") const {
    return "{type: gauss_newton, linear_solver: " + GetParam() + more + "}";
  }
};

INSTANTIATE_TEST_SUITE_P(Over, GaussNewton, testing::Values("dense_cholesky", "structured"),
                         [](const auto& info) { return info.param; });

TEST_P(GaussNewton, TellsOfItsSolve) {
  auto problem = sheet_problem({});
  const double before = problem.energy();
  const auto summary = solve(problem, solver());
  EXPECT_EQ(summary.solver, "gauss_newton");
  EXPECT_THAT(summary.linear_solver, testing::StartsWith(GetParam()));
  EXPECT_EQ(summary.termination, "converged");
  EXPECT_NEAR(summary.initial_energy, before, 1e-5 * before);
  EXPECT_NEAR(summary.final_energy, problem.energy(), 1e-4 * summary.final_energy);
  ASSERT_EQ(summary.energies.size(), static_cast<std::size_t>(summary.iterations));
  EXPECT_EQ(summary.energies.back(), summary.final_energy);
  EXPECT_GT(summary.iterations, 1);
}

TEST_P(GaussNewton, StopsAtTheMostIterations) {
  for (const int most : {1, 3, 200}) {
    auto problem = sheet_problem({.nodes = 9, .constraints = 60, .bend = 60});
    const auto summary = solve(problem, solver(", tolerance: 0, max_iterations: " + std::to_string(most)));
    EXPECT_LE(summary.iterations, most);
    if (most > 3) continue;
    EXPECT_EQ(summary.iterations, most);
    EXPECT_EQ(summary.termination, "max_iterations");
  }
}

TEST_P(GaussNewton, ASmallerToleranceTakesNoFewerIterations) {
  int fewest = 0;
  for (const char* tolerance : {"1e-1", "1e-3", "1e-5"}) {
    auto problem = sheet_problem({.bend = 60, .length_unit = 1000});
    const auto summary = solve(problem, solver(std::string(", tolerance: ") + tolerance));
    EXPECT_EQ(summary.termination, "converged");
    EXPECT_GE(summary.iterations, fewest);
    fewest = summary.iterations;
  }
  EXPECT_GT(fewest, 2);
}

TEST_P(GaussNewton, NeverAcceptsAStepThatRaisesTheEnergy) {
  int rejected = 0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    auto problem = sheet_problem({.nodes = 20, .constraints = 100, .seed = seed});
    randomise_unknowns(problem, 1.5, 100, seed);
    const auto summary = solve(problem, solver(", max_iterations: 100"));
    double last = summary.initial_energy;
    for (const double energy : summary.energies) {
      EXPECT_LE(energy, last);
      if (energy == last) ++rejected;
      last = energy;
    }
    EXPECT_LT(problem.energy(), 0.01 * summary.initial_energy);
    EXPECT_TRUE(all_finite(problem.unknowns().host()));
  }
  EXPECT_GT(rejected, 0) << "these starts were chosen because an undamped step would raise the energy";
}

TEST_P(GaussNewton, TheSameBitsEveryTime) {
  const auto solution = [&] {
    auto problem = sheet_problem({.nodes = 50, .constraints = 700});
    const auto summary = solve(problem, solver());
    return std::pair(problem.unknowns().host(), summary.energies);
  };
  EXPECT_EQ(solution(), solution());
}

TEST_P(GaussNewton, SolvesAgainFromWhereItStandsTowardsNewTargets) {
  const Sheet sheet{};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  Problem problem(graph, make_terms(energies_, constraints));
  const auto made = make<Solver>(registry_, solver());
  const auto bound = made->bind(problem, device_);
  bound->solve();
  bound->solve();
  for (auto& value : constraints->data.write_host()) value *= 1.5F;
  bound->solve();
  const auto summaries = bound->summaries();
  ASSERT_EQ(summaries.size(), 3U) << "solves are enqueued; all are told of afterwards";
  EXPECT_EQ(summaries[1].initial_energy, summaries[0].final_energy);
  EXPECT_LE(summaries[1].iterations, 2);
  EXPECT_GT(summaries[2].initial_energy, 2 * summaries[1].final_energy);
  EXPECT_NEAR(summaries[2].final_energy, problem.energy(), 1e-4 * problem.energy());

  Problem fresh(graph, make_terms(energies_, constraints));
  solve(fresh, solver());
  EXPECT_NEAR(problem.energy(), fresh.energy(), 1e-4 * fresh.energy()) << "the same as a solve from scratch";
}

TEST_P(GaussNewton, AStartThatIsNotFiniteFailsAndChangesNothing) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto problem = sheet_problem({.nodes = 9, .constraints = 50});
    problem.unknowns().write_host()[5] = bad;
    const auto summary = solve(problem, solver());
    EXPECT_EQ(summary.termination, "failed");
    EXPECT_THAT(summary.failure, testing::HasSubstr("not finite"));
    EXPECT_EQ(problem.unknowns().host()[4], 0);
  }
}

TEST_P(GaussNewton, ATargetThatIsNotFiniteFailsAndChangesNothing) {
  const Sheet sheet{.nodes = 9, .constraints = 50};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  constraints->data.write_host()[2] = std::numeric_limits<float>::quiet_NaN();
  Problem problem(graph, make_terms(energies_, constraints));
  EXPECT_EQ(solve(problem, solver()).termination, "failed");
  EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
}

TEST_P(GaussNewton, EndsWithoutADecreaseWhenNoDampingHelps) {
  const Sheet sheet{.nodes = 4, .constraints = 10};
  auto graph = make_sheet_graph(sheet);
  auto constraints = make_sheet_constraints(sheet, graph);
  constraints->points.write_host()[0] = 1e25F;  // its square has no place in single precision
  Problem problem(graph, make_terms(energies_, constraints));
  const auto summary = solve(problem, solver());
  EXPECT_EQ(summary.termination, "no_decrease");
  EXPECT_EQ(summary.final_energy, summary.initial_energy);
  EXPECT_THAT(problem.unknowns().host(), testing::Each(0)) << "the start, not NaN";
}

TEST_F(SolverTest, TheLinearSolverThatWasChosenForTheUserComesWithTheReason) {
  auto problem = sheet_problem({.nodes = 9, .constraints = 50});
  EXPECT_THAT(solve(problem, "{type: gauss_newton}").linear_solver,
              testing::ContainsRegex("^(structured|dense_cholesky): .+"));
}

TEST_F(SolverTest, DenseCholeskyTimesTheStagesOfTheThesis) {
  auto problem = sheet_problem({});
  device_.measure_stages(true);
  solve(problem, "{type: gauss_newton, linear_solver: dense_cholesky}");
  const auto times = device_.take_stage_times();
  for (const char* stage : {"jacobian", "mm", "mv", "cholesky", "solver", "energy"})
    EXPECT_GT(times.at(stage), 0) << stage;
}

}  // namespace
}  // namespace pliant::test
