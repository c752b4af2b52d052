#include "energies/energies.h"

#include <gmock/gmock.h>

#include "framework/problem/normal_equations.h"
#include "tests/problem/components.h"
#include "tests/problem/dense_normals.h"
#include "tests/problem/gradient_check.h"
#include "tests/problem/sheet_problem.h"

// What must hold for every registered energy, whatever it is called: a new one is tested by being listed.
namespace pliant::test {
namespace {

class EveryEnergy : public testing::Test {
 protected:
  EveryEnergy() {
    register_energies(registry_);
    energies_ = all_energies(registry_);
  }

  Registry registry_;
  std::vector<Energy> energies_;
};

TEST_F(EveryEnergy, IsNamedAndDescribed) {
  ASSERT_FALSE(energies_.empty());
  for (const auto* info : registry_.components(Energy::kind)) {
    EXPECT_FALSE(info->doc.empty()) << info->name;
    for (const auto& row : info->parameters.rows()) EXPECT_FALSE(row.doc().empty()) << info->name;
  }
}

TEST_F(EveryEnergy, TheAnalyticJacobianIsThatOfTheResidual) {
  for (const auto& energy : energies_)
    for (const unsigned seed : {1U, 2U, 3U})
      EXPECT_LT(jacobian_error(energy, seed), gradient_tolerance) << energy.equation.name;
}

// The text that the device compiles against the functions that the host compiles.
TEST_F(EveryEnergy, TheDeviceEvaluatesTheSameEquation) {
  Device device;
  for (const auto& energy : energies_) {
    SCOPED_TRACE(energy.equation.name);
    auto problem = make_sheet_problem({.nodes = 9, .constraints = 100}, {energy});
    for (const unsigned seed : {1U, 2U}) {
      randomise_unknowns(problem, 0.3, 10, seed);
      NormalEquations equations(device, problem);
      const auto expected = dense_normals(problem), found = device_normals(equations);
      ASSERT_GT(expected.matrix.norm(), 0);
      ASSERT_GT(expected.gradient.norm(), 0);
      EXPECT_LT((found.matrix - expected.matrix).norm(), 3e-6 * expected.matrix.norm());
      EXPECT_LT((found.gradient - expected.gradient).norm(), 3e-6 * expected.gradient.norm());
      EXPECT_NEAR(device_energy(equations, problem), problem.energy(), 3e-6 * problem.energy());
    }
  }
}

TEST_F(EveryEnergy, ScalesWithItsWeight) {
  for (auto energy : energies_) {
    SCOPED_TRACE(energy.equation.name);
    const auto value = [&](double weight) {
      energy.weight = weight;
      auto problem = make_sheet_problem({.nodes = 9, .constraints = 50}, {energy});
      randomise_unknowns(problem, 0.3, 10, 1);
      return problem.energy();
    };
    EXPECT_GT(value(1), 0);
    EXPECT_DOUBLE_EQ(value(2.5), 2.5 * value(1));
    EXPECT_EQ(value(0), 0);
  }
}

// A length divided by the unit, or not a length at all: in_length says which, and here it shows.
TEST_F(EveryEnergy, SaysWhetherItIsALength) {
  for (const auto& energy : energies_) {
    SCOPED_TRACE(energy.equation.name);
    const auto value = [&](float scale) {
      const Sheet sheet{.nodes = 9, .constraints = 50};
      auto graph = make_sheet_graph(sheet);
      const auto constraints = make_sheet_constraints(sheet, graph);
      for (auto& node : graph.nodes) node *= scale;
      for (auto& number : constraints->points.write_host()) number *= scale;
      auto& data = constraints->data.write_host();
      for (std::size_t i = 0; i < data.size(); ++i)
        if (i % 6 < 3) data[i] *= scale;
      Problem problem(graph, make_terms({energy}, constraints), scale);
      randomise_unknowns(problem, 0.3, 10 * scale, 1);
      return problem.energy();
    };
    EXPECT_NEAR(value(64), value(1), 1e-6 * value(1)) << "the same in another unit";
  }
}

}  // namespace
}  // namespace pliant::test
