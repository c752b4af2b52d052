#include <gmock/gmock.h>

#include <cstdlib>

#include "energies/energies.h"
#include "framework/config/config.h"
#include "framework/problem/solver.h"
#include "solvers/solvers.h"
#include "tests/problem/components.h"
#include "tests/problem/gradient_check.h"
#include "tests/problem/sheet_problem.h"

// What the reader of docs/adding-a-component.md has after the last step. Built by follow.cmake in a copy of
// the room `energies` that was changed as the document says.
namespace pliant::test {
namespace {

class Stillness : public testing::Test {
 protected:
  Stillness() {
    register_energies(registry_);
    register_solvers(registry_);
  }

  /// The energy at the minimum and how far the nodes moved, root mean square in mm.
  struct Solution {
    double energy;
    double motion;
  };
  Solution solve(const std::string& solver, double stillness) {
    auto energies = all_energies(registry_);
    for (auto& energy : energies)
      if (energy.equation.name == "stillness") energy.weight = stillness;
    auto problem = make_sheet_problem({.nodes = 25, .constraints = 200}, energies);
    const auto bound = make<Solver>(registry_, solver)->bind(problem, device_);
    bound->solve();
    EXPECT_EQ(bound->summaries().at(0).termination, "converged") << solver;
    double sum = 0;
    for (std::size_t i = 0; i < problem.unknowns().size(); ++i)
      if (i % 12 >= 9) sum += std::pow(problem.unknowns().host()[i], 2);
    return {problem.energy(), std::sqrt(sum / problem.node_count())};
  }

  Registry registry_;
  Device device_;
};

TEST_F(Stillness, IsListed) {
  const auto* info = registry_.find("energy", "stillness");
  ASSERT_NE(info, nullptr);
  EXPECT_THAT(registry_.components("energy"), testing::Contains(info));
  EXPECT_EQ(info->doc, "Keeps each node where it is");
}

TEST_F(Stillness, IsReadFromTheExperimentOfTheDocument) {
  const char* file = std::getenv("PLIANT_EXAMPLE");
  ASSERT_NE(file, nullptr);
  const auto experiment = load_experiment({file, {}, {}}, {components("energies", "energy")}, registry_);
  const auto& sections = experiment.values.sections("energies");
  const auto found = std::find_if(sections.begin(), sections.end(),
                                  [](const auto& section) { return section.first == "stillness"; });
  ASSERT_NE(found, sections.end());
  EXPECT_EQ(registry_.make<Energy>(found->second)->weight, 0.5);
}

TEST_F(Stillness, PassesTheGradientCheck) {
  EXPECT_LT(jacobian_error(*make<Energy>(registry_, "{type: stillness}"), 1), gradient_tolerance);
}

TEST_F(Stillness, IsSolvedByEverySolverToTheSameMinimum) {
  const auto solvers = registry_.components("solver");
  ASSERT_GE(solvers.size(), 2U);
  const auto expected = solve("{type: ceres_lm}", 0.5);
  for (const auto* info : solvers) {
    const auto found = solve("{type: " + info->name + "}", 0.5);
    EXPECT_NEAR(found.energy, expected.energy, 1e-4 * expected.energy) << info->name;
    const auto held = solve("{type: " + info->name + "}", 1e6);
    EXPECT_LT(held.motion, 0.01 * found.motion) << info->name << ": a heavy term holds the nodes";
  }
}

}  // namespace
}  // namespace pliant::test
