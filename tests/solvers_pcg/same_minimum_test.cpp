#include <gmock/gmock.h>

#include <functional>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "tests/device/shapes.h"
#include "tests/problem/components.h"
#include "tests/solvers/solve.h"
#include "tests/solvers_pcg/test_energies/test_energies.h"

// Every linear solver of gauss_newton, without being told its name: as good as Ceres in double.
namespace pliant::test {
namespace {

using MakeProblem = std::function<Problem()>;

class EveryLinearSolver : public SolverTest {
 protected:
  std::vector<std::string> linear_solvers() const {
    std::vector<std::string> names;
    for (const auto* info : registry_.components("linear_solver")) names.push_back(info->name);
    return names;
  }

  static std::string with(const std::string& linear_solver) {
    return "{type: gauss_newton, max_iterations: 100, tolerance: 1e-8, linear_solver: " + linear_solver + "}";
  }

  /// To 1e-5 of the energy; `refusing`: linear solvers that must say that they cannot.
  void expect_same_minimum(const MakeProblem& make, const std::vector<std::string>& refusing = {}) {
    auto problem = make();
    solve(problem, "{type: ceres_lm, tolerance: 1e-12, max_iterations: 300}");
    const double minimum = problem.energy();
    for (const auto& name : linear_solvers()) {
      SCOPED_TRACE(name);
      auto own = make();
      if (std::find(refusing.begin(), refusing.end(), name) != refusing.end()) {
        EXPECT_THROW(solve(own, with(name)), ConfigError);
        continue;
      }
      const auto summary = solve(own, with(name));
      EXPECT_EQ(summary.termination, "converged");
      EXPECT_NEAR(own.energy(), minimum, 1e-5 * minimum);
      EXPECT_NEAR(summary.final_energy, own.energy(), 1e-5 * own.energy());
    }
  }

  Problem problem_of(const Sheet& sheet, std::vector<Energy> more) const {
    auto energies = energies_;
    energies.insert(energies.end(), more.begin(), more.end());
    return make_sheet_problem(sheet, energies);
  }
};

TEST_F(EveryLinearSolver, FindsTheMinimumOfBentSheets) {
  expect_same_minimum([&] { return sheet_problem({.nodes = 60, .constraints = 900}); });
  expect_same_minimum(
      [&] { return sheet_problem({.nodes = 17, .constraints = 150, .bend = 60, .seed = 2}); });
  expect_same_minimum([&] {
    return sheet_problem({.nodes = 40, .constraints = 300, .per_point = 6, .length_unit = 1000, .seed = 3});
  });
}

// Few constraints far apart: the worst conditioned of what people do with embedded deformation.
TEST_F(EveryLinearSolver, FindsTheMinimumOfSurfacesBentByHandles) {
  for (const auto& sheet :
       {Sheet{.nodes = 49, .bend = 60, .seed = 6}, Sheet{.nodes = 120, .bend = 10, .seed = 6}})
    expect_same_minimum([&] {
      auto graph = make_sheet_graph(sheet);
      auto terms = make_terms(energies_, make_handles(sheet, graph));
      return Problem(std::move(graph), std::move(terms));
    });
}

TEST_F(EveryLinearSolver, TakesTermsOfConstraintsThatCoupleTheAxes) {
  expect_same_minimum([&] { return problem_of({.nodes = 30, .constraints = 400}, {to_plane()}); });
  expect_same_minimum([&] {
    return problem_of({.nodes = 30, .constraints = 400, .seed = 5}, {to_plane(), moves_as_far()});
  });
  expect_same_minimum(
      [&] { return problem_of({.nodes = 30, .constraints = 400, .length_unit = 1000}, {to_plane()}); });
}

TEST_F(EveryLinearSolver, TakesRobustLosses) {
  for (const auto& loss : loss_names()) {
    SCOPED_TRACE(loss);
    expect_same_minimum([&] {
      auto energies = energies_;
      for (auto& energy : energies)
        if (energy.stencil == Stencil::per_constraint) energy.loss = {loss, 40};
      return make_sheet_problem({.nodes = 30, .constraints = 400, .bend = 10}, energies);
    });
  }
}

TEST_F(EveryLinearSolver, TakesSetsOfConstraintsOverDifferentNumbersOfNodes) {
  expect_same_minimum([&] {
    const Sheet sheet{.nodes = 24, .constraints = 200};
    auto few = sheet;
    few.per_point = 2;
    few.constraints = 70;
    auto graph = make_sheet_graph(sheet);
    auto terms = make_terms(energies_, make_sheet_constraints(sheet, graph));
    const auto others = make_sheet_constraints(few, graph);
    auto weak = *make<Energy>(registry_, "{type: constraint, weight: 7}");
    terms.push_back({weak, others});
    terms.push_back({to_plane(), others});
    return Problem(std::move(graph), std::move(terms));
  });
}

TEST_F(EveryLinearSolver, TakesSeveralTermsPerNodeAndPerEdge) {
  expect_same_minimum([&] {
    auto twice = energies_;
    for (auto& energy : twice) energy.weight *= 0.3;
    twice.push_back(stays());
    return problem_of({.nodes = 25, .constraints = 200}, twice);
  });
}

TEST_F(EveryLinearSolver, TakesTermsOfEdgesThatCoupleTheAxesOrSaysThatItCannot) {
  expect_same_minimum([&] { return problem_of({.nodes = 25, .constraints = 300}, {keeps_length()}); },
                      {"structured"});
}

TEST_F(EveryLinearSolver, StartsFromWhereTheProblemStands) {
  expect_same_minimum([&] {
    auto problem = problem_of({.nodes = 20, .constraints = 300, .seed = 4}, {to_plane()});
    randomise_unknowns(problem, 0.1, 10, 3);
    return problem;
  });
}

/// Work-items that share a system, as on GPUs.
class LinearSolverInAGroup : public EveryLinearSolver {
 protected:
  void expect_same_as_alone(const std::string& linear_solver, const MakeProblem& make) {
    SCOPED_TRACE(linear_solver);
    auto alone = make();
    auto together = make();
    solve(alone, with(linear_solver));
    const auto summary = solve(together, with(linear_solver), group_);
    EXPECT_EQ(summary.termination, "converged");
    EXPECT_NEAR(together.energy(), alone.energy(), 1e-5 * alone.energy());
    EXPECT_NEAR(summary.final_energy, together.energy(), 1e-5 * together.energy());
  }

  Device group_{"any", gpu_shape};
};

// Sixteen nodes at once: of 17 most of eight work-items have none, of 150 some have twice as many as others.
TEST_F(LinearSolverInAGroup, FindsWhatOneWorkItemFinds) {
  for (const auto& name : {"structured", "block_pcg"})
    for (const int nodes : {17, 150})
      expect_same_as_alone(name, [&] { return sheet_problem({.nodes = nodes, .constraints = 900}); });
}

TEST_F(LinearSolverInAGroup, TakesTermsOfConstraintsThatCoupleTheAxes) {
  expect_same_as_alone("structured",
                       [&] { return problem_of({.nodes = 150, .constraints = 900}, {to_plane()}); });
}

TEST_F(LinearSolverInAGroup, SolvesForRigidNodes) {
  expect_same_as_alone("block_pcg", [&] {
    const Sheet sheet{.nodes = 40, .constraints = 400};
    auto graph = make_sheet_graph(sheet);
    auto terms = make_terms(energies_, make_sheet_constraints(sheet, graph));
    return Problem(std::move(graph), std::move(terms), 1, quaternion_transform());
  });
}

TEST_F(EveryLinearSolver, GivesTheSameBitsEveryTime) {
  for (const auto& name : linear_solvers()) {
    const auto solution = [&] {
      auto problem = problem_of({.nodes = 40, .constraints = 500}, {to_plane()});
      const auto summary = solve(problem, with(name));
      return std::pair(problem.unknowns().host(), summary.energies);
    };
    EXPECT_EQ(solution(), solution()) << name;
  }
}

TEST_F(EveryLinearSolver, NeverRaisesTheEnergyNorReturnsNaN) {
  for (const auto& name : linear_solvers())
    for (const unsigned seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      auto problem = problem_of({.nodes = 15, .constraints = 60, .seed = seed}, {to_plane()});
      randomise_unknowns(problem, 1.5, 100, seed);
      const double before = problem.energy();
      const auto summary = solve(problem, with(name));
      double last = before * (1 + 1e-5);
      for (const double energy : summary.energies) {
        EXPECT_LE(energy, last);
        last = energy;
      }
      EXPECT_TRUE(all_finite(problem.unknowns().host()));
      EXPECT_LT(problem.energy(), 0.1 * before);
    }
}

TEST_F(EveryLinearSolver, LeavesAloneWhatNothingTouches) {
  const Sheet sheet{.nodes = 20, .constraints = 120};
  for (const auto& name : linear_solvers()) {
    SCOPED_TRACE(name);
    auto graph = make_sheet_graph(sheet);
    const auto constraints = make_sheet_constraints(sheet, graph);
    graph.nodes.emplace_back(700, 700, 800);
    Problem problem(graph, make_terms(energies_, constraints));
    const auto summary = solve(problem, with(name));
    EXPECT_EQ(summary.termination, "converged");
    EXPECT_LT(problem.energy(), 0.5 * summary.initial_energy);
    const auto& unknowns = problem.unknowns().host();
    EXPECT_THAT(std::vector<float>(unknowns.end() - affine_size, unknowns.end()), testing::Each(0));
  }
}

TEST_F(EveryLinearSolver, StaysAtRestWithoutConstraintsOrWithNoneInForce) {
  for (const auto& name : linear_solvers())
    for (const int count : {0, 30}) {
      SCOPED_TRACE(testing::Message() << name << ", " << count << " constraints");
      const Sheet sheet{.nodes = 12, .constraints = count};
      auto graph = make_sheet_graph(sheet);
      const auto constraints = make_sheet_constraints(sheet, graph);
      for (auto& confidence : constraints->confidence.write_host()) confidence = 0;
      auto energies = energies_;
      energies.push_back(to_plane());
      Problem problem(graph, make_terms(energies, constraints));
      const auto summary = solve(problem, with(name));
      EXPECT_EQ(summary.termination, "converged");
      EXPECT_EQ(summary.final_energy, 0);
      EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
    }
}

TEST_F(EveryLinearSolver, SolvesAgainTowardsNewTargets) {
  for (const auto& name : linear_solvers()) {
    SCOPED_TRACE(name);
    const Sheet sheet{.nodes = 25, .constraints = 250};
    auto graph = make_sheet_graph(sheet);
    const auto constraints = make_sheet_constraints(sheet, graph);
    auto energies = energies_;
    energies.push_back(to_plane());
    Problem problem(graph, make_terms(energies, constraints));
    const auto solver = make<Solver>(registry_, with(name));
    const auto bound = solver->bind(problem, device_);
    bound->solve();
    for (auto& value : constraints->data.write_host()) value *= 1.3F;
    for (std::size_t i = 0; i < constraints->size(); i += 3) constraints->confidence.write_host()[i] = 0.25F;
    bound->solve();
    bound->summaries();
    Problem fresh(graph, make_terms(energies, constraints));
    solve(fresh, "{type: ceres_lm, tolerance: 1e-12, max_iterations: 300}");
    EXPECT_NEAR(problem.energy(), fresh.energy(), 1e-5 * fresh.energy());
  }
}

TEST_F(EveryLinearSolver, TheAutomaticOneSaysWhatItChoseAndWhy) {
  auto separable = sheet_problem({.nodes = 9, .constraints = 50});
  EXPECT_THAT(solve(separable, "{type: gauss_newton}").linear_solver, testing::StartsWith("structured: "));
  auto coupled = problem_of({.nodes = 9, .constraints = 50}, {keeps_length()});
  EXPECT_THAT(solve(coupled, "{type: gauss_newton}").linear_solver,
              testing::AllOf(testing::StartsWith("block_pcg: "), testing::HasSubstr("keeps_length")));
}

}  // namespace
}  // namespace pliant::test
