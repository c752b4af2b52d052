#include "framework/problem/energy.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "energies/energies.h"
#include "tests/problem/components.h"

namespace pliant::test {
namespace {

TEST(Stencil, HasANameAndSizesThatFitTheBuffers) {
  for (const auto stencil : {Stencil::per_node, Stencil::per_edge, Stencil::per_constraint}) {
    EXPECT_THAT(to_string(stencil), testing::StartsWith("per_"));
    EXPECT_LE(input_size(stencil), max_stencil_inputs);
    EXPECT_LE(data_size(stencil), max_stencil_data);
  }
}

TEST(AddEnergy, TheWeightIsAParameterWithTheEnergysDefault) {
  Registry registry;
  register_energies(registry);
  EXPECT_EQ(make<Energy>(registry, "{type: regularization}")->weight, 10);
  EXPECT_EQ(make<Energy>(registry, "{type: regularization, weight: 2.5}")->weight, 2.5);
  EXPECT_EQ(registry.find("energy", "regularization")->parameters.find("weight")->lowest(), 0);
}

TEST(AddEnergy, RefusesAResidualThatTheSolversHaveNoRoomFor) {
  Registry registry;
  register_energies(registry);
  Energy energy = *make<Energy>(registry, "{type: rotation}");
  for (const int residuals : {0, max_residuals + 1}) {
    energy.residuals = residuals;
    EXPECT_THROW(add_energy(registry, "other", "", energy), std::logic_error);
  }
  energy.residuals = max_residuals;
  EXPECT_NO_THROW(add_energy(registry, "other", "", energy));
}

}  // namespace
}  // namespace pliant::test
