#include <gmock/gmock.h>

#include <limits>

#include "framework/deformation/warp.h"
#include "tests/problem/components.h"
#include "tests/solvers/solve.h"

// Problems whose J^T J is singular: what nothing asks for stays where it is, the rest is solved.
namespace pliant::test {
namespace {

class SingularProblem : public SolverTest {
 protected:
  static constexpr std::array<const char*, 5> kSolvers{
      "{type: gauss_newton, max_iterations: 200}",
      "{type: gauss_newton, linear_solver: structured, max_iterations: 200}",
      "{type: gauss_newton, linear_solver: block_pcg, max_iterations: 200}",
      "{type: gauss_newton, linear_solver: dense_cholesky, max_iterations: 200}", "{type: ceres_lm}"};

  Energy energy(const std::string& yaml) const { return *make<Energy>(registry_, yaml); }

  /// Solves with all; the solutions are finite and equally good.
  void expect_solved(Problem& problem) {
    const Array<float> start = problem.unknowns().clone();
    const double before = problem.energy();
    std::vector<double> ends;
    for (const char* solver : kSolvers) {
      SCOPED_TRACE(solver);
      problem.unknowns() = start.clone();
      const auto summary = solve(problem, solver);
      EXPECT_EQ(summary.termination, "converged");
      EXPECT_TRUE(all_finite(problem.unknowns().host()));
      EXPECT_NEAR(summary.final_energy, problem.energy(), 1e-4 * problem.energy() + 1e-6 * before);
      ends.push_back(problem.energy());
    }
    for (const double end : ends) EXPECT_NEAR(end, ends.back(), 1e-4 * ends.back() + 1e-6 * before);
  }

  static std::vector<float> form_of(const Problem& problem, int node) {
    const auto begin = problem.unknowns().host().begin() + affine_size * node;
    return {begin, begin + affine_size};
  }
};

TEST_F(SingularProblem, NodesThatNothingTouchesStay) {
  const Sheet sheet{.nodes = 12, .constraints = 100};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  graph.nodes.emplace_back(900, 900, 800);  // an isolated node, with neither edges nor constraints
  Problem problem(graph, make_terms(energies_, constraints));
  for (const char* solver : kSolvers) {
    problem.reset_to_identity();
    const auto summary = solve(problem, solver);
    EXPECT_EQ(summary.termination, "converged");
    EXPECT_LT(problem.energy(), 0.5 * summary.initial_energy);
    EXPECT_THAT(form_of(problem, 12), testing::Each(0)) << solver;
  }
  problem.reset_to_identity();
  expect_solved(problem);
}

TEST_F(SingularProblem, ConstraintsAloneWithoutARegularization) {
  const Sheet sheet{.nodes = 12, .constraints = 15};
  auto graph = make_sheet_graph(sheet);
  Problem problem(graph, make_terms({energy("{type: constraint}")}, make_sheet_constraints(sheet, graph)));
  expect_solved(problem);
  EXPECT_LT(problem.energy(), 1);
}

TEST_F(SingularProblem, WithoutAnyConstraintTheRestShapeIsTheMinimum) {
  const Sheet sheet{.nodes = 12, .constraints = 0};
  auto problem = sheet_problem(sheet);
  for (const char* solver : kSolvers) {
    const auto summary = solve(problem, solver);
    EXPECT_EQ(summary.termination, "converged") << solver;
    EXPECT_EQ(summary.final_energy, 0);
    EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
  }
  randomise_unknowns(problem, 0.1, 10, 1);
  const double before = problem.energy();
  for (const char* solver : kSolvers) {
    randomise_unknowns(problem, 0.1, 10, 1);
    solve(problem, solver);
    EXPECT_LT(problem.energy(), 1e-4 * before) << solver << " finds some rigid motion of the rest shape";
  }
}

TEST_F(SingularProblem, AllConstraintsOutOfForce) {
  const Sheet sheet{.nodes = 8, .constraints = 40};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  for (auto& confidence : constraints->confidence.write_host()) confidence = 0;
  Problem problem(graph, make_terms(energies_, constraints));
  expect_solved(problem);
  EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
}

TEST_F(SingularProblem, WhatIsNotInForceMayBeAnything) {
  const Sheet sheet{.nodes = 8, .constraints = 40};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  for (std::size_t i = 0; i < 10; ++i) {
    constraints->confidence.write_host()[i] = 0;
    constraints->data.write_host()[6 * i + i % 6] = std::numeric_limits<float>::quiet_NaN();
  }
  Problem problem(graph, make_terms(energies_, constraints));
  expect_solved(problem);
}

TEST_F(SingularProblem, AllWeightsZero) {
  auto energies = energies_;
  for (auto& energy : energies) energy.weight = 0;
  auto problem = make_sheet_problem({.nodes = 8, .constraints = 40}, energies);
  randomise_unknowns(problem, 0.1, 10, 1);
  const auto start = problem.unknowns().host();
  for (const char* solver : kSolvers) {
    const auto summary = solve(problem, solver);
    EXPECT_EQ(summary.termination, "converged") << solver;
    EXPECT_EQ(summary.initial_energy, 0);
    EXPECT_EQ(summary.final_energy, 0);
    EXPECT_EQ(problem.unknowns().host(), start);
  }
}

TEST_F(SingularProblem, OneWeightZero) {
  for (const char* zero : {"rotation", "regularization"}) {
    SCOPED_TRACE(zero);
    auto energies = energies_;
    for (auto& energy : energies)
      if (energy.equation.name == zero) energy.weight = 0;
    auto problem = make_sheet_problem({.nodes = 10, .constraints = 300, .relief = 0}, energies);
    expect_solved(problem);
  }
}

TEST_F(SingularProblem, WithoutAnyTerm) {
  Problem problem(make_sheet_graph({.nodes = 5}), {});
  for (const char* solver : kSolvers) {
    const auto summary = solve(problem, solver);
    EXPECT_EQ(summary.termination, "converged") << solver;
    EXPECT_EQ(summary.final_energy, 0);
    EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
  }
}

TEST_F(SingularProblem, AGraphOfOneNode) {
  auto problem = sheet_problem({.nodes = 1, .constraints = 30});
  expect_solved(problem);
  problem.reset_to_identity();
  auto single = sheet_problem({.nodes = 1, .constraints = 1});
  expect_solved(single);
}

TEST_F(SingularProblem, AFlatSheetLeavesWhatLiesAcrossItFree) {
  const Sheet sheet{.nodes = 6, .constraints = 100, .relief = 0};
  auto graph = make_sheet_graph(sheet);
  Problem problem(graph, make_terms({energy("{type: constraint}")}, make_sheet_constraints(sheet, graph)));
  expect_solved(problem);
}

TEST_F(SingularProblem, PointsOnALineLeaveWhatLiesAcrossItFree) {
  const Sheet sheet{.nodes = 6, .constraints = 30};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  auto& points = constraints->points.write_host();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i % 3 != 0) points[i] = 0.3F * points[i - i % 3] + 500;
  Problem problem(graph, make_terms({energy("{type: constraint}")}, constraints));
  expect_solved(problem);
}

}  // namespace
}  // namespace pliant::test
