#include "framework/problem/solver.h"

#include <fmt/format.h>

namespace pliant {

std::string SolverSummary::report() const {
  std::string text = fmt::format("{} ({}): energy {:.6g} -> {:.6g} in {} iterations, {}\n", solver,
                                 linear_solver, initial_energy, final_energy, iterations, termination);
  if (linear_iterations > 0) text += fmt::format("  {} iterations of the linear solver\n", linear_iterations);
  for (std::size_t i = 0; i < energies.size(); ++i)
    text += fmt::format("  {:3d}  {:.9g}\n", i + 1, energies[i]);
  for (const auto& [stage, milliseconds] : time_ms)
    text += fmt::format("  {:<12} {:.3f} ms\n", stage, milliseconds);
  return text;
}

}  // namespace pliant
