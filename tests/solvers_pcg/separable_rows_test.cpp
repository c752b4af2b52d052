#include <gmock/gmock.h>

#include <array>
#include <random>

#include "energies/energies.h"
#include "tests/problem/components.h"
#include "tests/solvers_pcg/test_energies/test_energies.h"

// An energy that says it treats the axes alike and apart must do so: its scalar row is its Jacobian.
namespace pliant::test {
namespace {

std::vector<Energy> separable_energies() {
  Registry registry;
  register_energies(registry);
  std::vector<Energy> separable{stays()};
  for (const auto& energy : all_energies(registry))
    if (energy.equation.axis_separable()) separable.push_back(energy);
  return separable;
}

class Draws {
 public:
  template <std::size_t N>
  std::array<double, N> numbers() {
    std::array<double, N> drawn{};
    for (auto& number : drawn) number = normal_(generator_);
    return drawn;
  }

 private:
  std::mt19937 generator_{7};
  std::normal_distribution<double> normal_{0, 20};
};

/// Empty when row and Jacobian agree, else where they do not.
std::string disagreement(const Energy& energy, Draws& draws) {
  const auto u = draws.numbers<max_stencil_inputs>();
  const auto data = draws.numbers<max_stencil_data>();
  std::array<double, max_residuals * max_stencil_inputs> J{};
  std::array<double, max_stencil_inputs> row{};
  energy.equation.jacobian(u.data(), data.data(), J.data());
  energy.equation.row(data.data(), row.data());
  const auto inputs = static_cast<std::size_t>(input_size(energy.stencil));
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t input = 0; input < inputs; ++input) {
      const double expected = input % 3 == axis ? row[input / 3] : 0;
      if (std::abs(J[inputs * axis + input] - expected) > 1e-9 * (1 + std::abs(expected)))
        return "axis " + std::to_string(axis) + ", input " + std::to_string(input);
    }
  return "";
}

TEST(SeparableRows, AreTheJacobiansOfTheirEnergies) {
  Draws draws;
  for (const auto& energy : separable_energies()) {
    SCOPED_TRACE(energy.equation.name);
    EXPECT_EQ(energy.residuals, 3) << "one residual an axis";
    for (int trial = 0; trial < 20; ++trial) EXPECT_EQ(disagreement(energy, draws), "");
  }
}

TEST(SeparableRows, OfTheThesisAreDeclared) {
  std::vector<std::string> names;
  for (const auto& energy : separable_energies()) names.push_back(energy.equation.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"regularization", "constraint"}));
  EXPECT_THAT(names, testing::Not(testing::Contains("rotation")));
}

TEST(SeparableRows, AWrongRowIsFoundOut) {
  Draws draws;
  auto wrong = stays();
  wrong.equation.row = [](const double*, double* row) { row[0] = row[1] = row[2] = row[3] = 1; };
  EXPECT_NE(disagreement(wrong, draws), "");
}

}  // namespace
}  // namespace pliant::test
