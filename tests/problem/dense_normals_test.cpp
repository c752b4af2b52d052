#include "tests/problem/dense_normals.h"

#include <gtest/gtest.h>

#include "energies/energies.h"
#include "tests/problem/components.h"
#include "tests/problem/sheet_problem.h"

namespace pliant::test {
namespace {

// The reference itself: its gradient is half the derivative of Problem::energy.
TEST(DenseNormals, TheGradientIsHalfTheDerivativeOfTheEnergy) {
  Registry registry;
  register_energies(registry);
  auto problem = make_sheet_problem({.nodes = 6, .constraints = 20}, all_energies(registry));
  randomise_unknowns(problem, 0.2, 5, 3);
  const auto normals = dense_normals(problem);
  const auto& start = problem.unknowns().host();
  std::vector<double> unknowns(start.begin(), start.end());
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const double step = 1e-4;
    const double middle = unknowns[i];
    unknowns[i] = middle + step;
    const double above = problem.energy(unknowns);
    unknowns[i] = middle - step;
    const double below = problem.energy(unknowns);
    unknowns[i] = middle;
    EXPECT_NEAR((above - below) / (4 * step), normals.gradient[static_cast<Eigen::Index>(i)],
                1e-6 * normals.gradient.cwiseAbs().maxCoeff())
        << "unknown " << i;
  }
}

}  // namespace
}  // namespace pliant::test
