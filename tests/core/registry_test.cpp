#include "framework/core/registry.h"

#include <stdexcept>

#include <gmock/gmock.h>

#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

TEST(Registry, KeepsTheOrderOfRegistration) {
  const Registry registry = toy_registry();
  EXPECT_THAT(registry.kinds(),
              testing::ElementsAre("energy", "solver", "linear_solver", "data", "alignment"));
  std::vector<std::string> names;
  for (const auto* info : registry.components("solver")) names.push_back(info->name);
  EXPECT_THAT(names, testing::ElementsAre("gauss_newton", "ceres_lm"));
  EXPECT_TRUE(registry.components("nonsense").empty());
}

TEST(Registry, FindsByKindAndName) {
  const Registry registry = toy_registry();
  ASSERT_NE(registry.find("energy", "rotation"), nullptr);
  EXPECT_EQ(registry.find("energy", "rotation")->doc, "Keeps the nodes rigid");
  EXPECT_EQ(registry.find("solver", "rotation"), nullptr);
}

TEST(Registry, MakesTheComponentThatASectionNames) {
  const Registry registry = toy_registry();
  const auto energy = registry.make<Energy>(Parameters("rotation", {{"weight", 2.5}}));
  EXPECT_EQ(energy->weight, 2.5);
  EXPECT_THROW(registry.make<Energy>(Parameters("nonsense", {})), std::logic_error);
}

TEST(Registry, RefusesWhatCouldNotBeNamedInAFile) {
  Registry registry = toy_registry();
  const Registry::Factory<Solver> none;
  EXPECT_THROW(registry.add<Solver>("ceres_lm", "", {}, none), std::logic_error);
  EXPECT_THROW(registry.add<Solver>("a", "", {text("type", "x")}, none), std::logic_error);
  EXPECT_THROW(registry.add<Solver>("b", "", {overrides("with")}, none), std::logic_error);
  EXPECT_THROW(registry.add<Solver>("c", "", {group("g", {overrides("with")})}, none), std::logic_error);
  EXPECT_NO_THROW(registry.add<Solver>("d", "", {group("g", {text("with", "")})}, none));
}

}  // namespace
}  // namespace pliant::test
