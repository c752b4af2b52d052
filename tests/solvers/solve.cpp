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

std::vector<std::string> SolverTest::all_solvers(const std::string& options) const {
  std::vector<std::string> all;
  for (const auto* info : registry_.components(Solver::kind)) {
    const auto* row = info->parameters.find("linear_solver");
    std::vector<std::string> linear_solvers = row->choices();
    if (row->type() == ParameterType::component)
      for (const auto* linear : registry_.components(row->kind())) linear_solvers.push_back(linear->name);
    for (const auto& linear : linear_solvers)
      all.push_back("{type: " + info->name + ", linear_solver: " + linear + ", " + options + "}");
  }
  return all;
}

SolverSummary SolverTest::solve(Problem& problem, const std::string& yaml, Device& device) const {
  const auto solver = make<Solver>(registry_, yaml);
  const auto bound = solver->bind(problem, device);
  bound->solve();
  return bound->summaries().at(0);
}

bool all_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace pliant::test
