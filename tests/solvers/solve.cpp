#include "tests/solvers/solve.h"

#include <algorithm>
#include <cmath>

#include "energies/energies.h"
#include "solvers/solvers.h"
#include "tests/problem/components.h"

namespace pliant::test {

SolverTest::SolverTest() {
  register_energies(registry_);
  register_solvers(registry_);
  energies_ = all_energies(registry_);
}

SolverSummary SolverTest::solve(Problem& problem, const std::string& yaml) {
  const auto solver = make<Solver>(registry_, yaml);
  const auto bound = solver->bind(problem, device_);
  bound->solve();
  return bound->summaries().at(0);
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace pliant::test
