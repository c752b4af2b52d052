#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "framework/deformation/warp.h"
#include "tests/problem/components.h"
#include "tests/solvers/solve.h"
#include "tests/solvers_pcg/reference_minimiser.h"
#include "tests/solvers_pcg/test_energies/test_energies.h"

// `structured`, stopped after any of its iterations, is where its reference in double is then.
namespace pliant::test {
namespace {

using MakeProblem = std::function<Problem()>;
using Unknowns = std::vector<float>;

/// In mm: what affine forms do at 100 mm from their nodes.
double distance(const Unknowns& a, const Unknowns& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::pow((i % affine_size < 9 ? 100 : 1) * static_cast<double>(a[i] - b[i]), 2);
  return std::sqrt(sum);
}

struct Limits {
  double agreement = 1e-4;  ///< of the way from the start
  double tolerance = 1e-6;  ///< of the minimisation
  int iterations = 20;
};

class StructuredIterations : public SolverTest {
 protected:
  SolverSummary solve_up_to(Problem& problem, const Limits& limits, int iterations) {
    testing::Message yaml;
    yaml << "{type: gauss_newton, linear_solver: structured, damping: 1e-6, tolerance: " << limits.tolerance
         << ", max_iterations: " << iterations << "}";
    return solve(problem, yaml.GetString());
  }

  /// To what the condition of the problem makes of single precision (measured: a tenth of `agreement`). It
  /// may tip the scales for one iteration of the linear solver. Returns how many steps were rejected.
  int expect_same_iterates(const MakeProblem& make, const Limits& limits = {}) {
    auto followed = make();
    const Unknowns start = followed.unknowns().host();
    ReferenceMinimiser reference(followed, limits.iterations, limits.tolerance, 1e-6);
    const double initial = reference.energy();
    int rejected = 0;
    for (int iterations = 1; iterations <= limits.iterations && reference.termination() == 0; ++iterations) {
      SCOPED_TRACE(testing::Message() << "after " << iterations << " iterations");
      const double before = reference.energy();
      reference.iterate();
      rejected += static_cast<int>(reference.energy() == before);
      auto problem = make();
      const auto summary = solve_up_to(problem, limits, iterations);
      const auto &found = problem.unknowns().host(), &expected = followed.unknowns().host();
      EXPECT_EQ(summary.iterations, reference.iterations());
      EXPECT_NEAR(summary.linear_iterations, reference.linear_iterations(), 1);
      EXPECT_NEAR(summary.final_energy, reference.energy(), 5e-7 * initial);
      EXPECT_LT(distance(found, expected), limits.agreement * distance(expected, start));
    }
    EXPECT_NE(reference.termination(), 0);
    return rejected;
  }

  Problem sheet_with(const Sheet& sheet, const std::vector<Energy>& more) const {
    auto energies = energies_;
    energies.insert(energies.end(), more.begin(), more.end());
    return make_sheet_problem(sheet, energies);
  }
};

TEST_F(StructuredIterations, OfEnergiesThatSeparate) {
  expect_same_iterates([&] { return sheet_problem({.nodes = 18, .constraints = 150}); });
}

TEST_F(StructuredIterations, OfStepsThatAreRejected) {
  const Sheet sheet{.nodes = 17, .constraints = 150, .bend = 80, .seed = 2};
  EXPECT_GT(expect_same_iterates([&] { return sheet_problem(sheet); }), 0);
}

TEST_F(StructuredIterations, OfTermsThatCoupleTheAxes) {
  expect_same_iterates([&] {
    return sheet_with({.nodes = 18, .constraints = 150}, {to_plane(), moves_as_far()});
  });
}

TEST_F(StructuredIterations, OfRobustLosses) {
  for (const auto& loss : loss_names()) {
    SCOPED_TRACE(loss);
    expect_same_iterates([&] {
      auto energies = energies_;
      for (auto& energy : energies)
        if (energy.stencil == Stencil::per_constraint) energy.loss = {loss, 20};
      return make_sheet_problem({.nodes = 18, .constraints = 150, .bend = 10}, energies);
    });
  }
}

// Then the noise estimate alone ends a step's conjugate gradients. Later iterations follow rounding errors.
TEST_F(StructuredIterations, DownToTheNoise) {
  for (const auto& [seed, iterations] : {std::pair(1U, 4), std::pair(3U, 5)})
    expect_same_iterates(
        [seed = seed, this] { return sheet_problem({.nodes = 18, .constraints = 150, .seed = seed}); },
        {.tolerance = 0, .iterations = iterations});
}

TEST_F(StructuredIterations, FromFarOff) {
  expect_same_iterates(
      [&] {
        auto problem = sheet_problem({.nodes = 15, .constraints = 60});
        randomise_unknowns(problem, 1.5, 100, 1);
        return problem;
      },
      {.agreement = 1e-3});
}

}  // namespace
}  // namespace pliant::test
