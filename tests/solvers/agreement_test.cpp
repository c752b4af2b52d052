#include <gmock/gmock.h>

#include "tests/problem/components.h"
#include "tests/solvers/solve.h"

// Every solver ends at the same minimum of the same problem.
namespace pliant::test {
namespace {

class Agreement : public SolverTest {
 protected:
  void expect_same_minimum(Problem problem) {
    const auto start = problem.unknowns().clone();
    const double before = problem.energy();
    std::optional<double> minimum;
    for (const auto& yaml : all_solvers()) {
      SCOPED_TRACE(yaml);
      problem.unknowns() = start.clone();
      const auto summary = solve(problem, yaml);
      const double after = problem.energy();
      EXPECT_EQ(summary.termination, "converged");
      EXPECT_NEAR(summary.initial_energy, before, 1e-5 * before);
      EXPECT_NEAR(summary.final_energy, after, 1e-4 * after + 1e-9 * before);
      EXPECT_LT(after, before);
      if (!minimum) minimum = after;
      EXPECT_NEAR(after, *minimum, 1e-4 * *minimum);
    }
  }
};

TEST_F(Agreement, ThereAreFourWaysToSolveAtLeast) {
  EXPECT_THAT(all_solvers(), testing::SizeIs(testing::Ge(4)));
  EXPECT_THAT(all_solvers(), testing::Contains(testing::HasSubstr("cgnr")));
  EXPECT_THAT(all_solvers(), testing::Contains(testing::HasSubstr("dense_cholesky")));
}

TEST_F(Agreement, OnBentSheets) {
  expect_same_minimum(sheet_problem({.nodes = 16, .constraints = 300}));
  expect_same_minimum(sheet_problem({.nodes = 64, .constraints = 1000, .bend = 50, .seed = 2}));
  expect_same_minimum(sheet_problem({.nodes = 40, .constraints = 400, .per_point = 6, .seed = 3}));
}

TEST_F(Agreement, InMetresWhereTheRotationTermDominates) {
  expect_same_minimum(sheet_problem({.nodes = 36, .constraints = 400, .length_unit = 1000, .seed = 4}));
}

TEST_F(Agreement, FromAStartFarFromTheIdentity) {
  auto problem = sheet_problem({.nodes = 25, .constraints = 300, .seed = 5});
  randomise_unknowns(problem, 0.1, 20, 1);
  expect_same_minimum(std::move(problem));
}

// No depth maps anywhere: a surface bent by a few moved handles [Sumner et al. 2007].
TEST_F(Agreement, OnASurfaceBentByHandles) {
  const Sheet sheet{.nodes = 49, .bend = 60, .seed = 6};
  auto graph = make_sheet_graph(sheet);
  auto terms = make_terms(energies_, make_handles(sheet, graph));
  expect_same_minimum(Problem(std::move(graph), std::move(terms)));
}

TEST_F(Agreement, WithConfidencesAndTargetsOutOfForce) {
  const Sheet sheet{.nodes = 20, .constraints = 300, .seed = 7};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  for (std::size_t i = 0; i < constraints->size(); ++i) {
    constraints->confidence.write_host()[i] = 0.5F * static_cast<float>(i % 3);
    if (i % 3 == 0) constraints->data.write_host()[6 * i + 2] = std::nanf("");
  }
  expect_same_minimum(Problem(graph, make_terms(energies_, constraints)));
}

}  // namespace
}  // namespace pliant::test
