#include "experiments/tasks/result_parts.h"

#include <fmt/format.h>

namespace pliant {

using nlohmann::ordered_json;

ordered_json counts_json(const NonRigidResult::Counts& counts) {
  return {{"source_points", counts.source_points},
          {"matched_points", counts.matched_points},
          {"nodes", counts.nodes},
          {"edges", counts.edges},
          {"constraints", counts.constraints},
          {"unknowns", counts.unknowns},
          {"outer_iterations", counts.outer_iterations},
          {"solver_iterations", counts.solver_iterations}};
}

ordered_json energy_json(const NonRigidResult::Energy& energy) {
  return {{"initial", energy.initial}, {"final", energy.final}, {"per_iteration", energy.per_iteration}};
}

ordered_json solver_json(const NonRigidResult::SolverRecord& solver) {
  return {
      {"name", solver.name}, {"linear_solver", solver.linear_solver}, {"termination", solver.termination}};
}

Table counts_table(const NonRigidResult::Counts& counts) {
  Table table{"Counts", {}, {}};
  const auto add = [&](const char* name, int count) {
    table.rows.push_back({{name, std::to_string(count)}});
  };
  add("Source points", counts.source_points);
  add("Nodes", counts.nodes);
  add("Edges", counts.edges);
  add("Constraints", counts.constraints);
  add("Unknowns", counts.unknowns);
  if (counts.outer_iterations > 0) add("Outer iterations", counts.outer_iterations);
  add("Solver iterations", counts.solver_iterations);
  return table;
}

Series energy_series(const NonRigidResult::Energy& energy, const std::string& step) {
  Series series{"Energy", step, "energy", {energy.initial}};
  series.values.insert(series.values.end(), energy.per_iteration.begin(), energy.per_iteration.end());
  series.note = fmt::format("From {:.6g} to {:.6g}.", energy.initial, energy.final);
  return series;
}

std::string change(double before, double after) { return fmt::format("{:.2f} -> {:.2f}", before, after); }

std::vector<std::string> notes_of(const std::string& ending, const std::vector<std::string>& warnings,
                                  const Timing& timing) {
  std::vector<std::string> notes{ending};
  for (const std::string& warning : warnings) notes.push_back("warning: " + warning);
  if (timing.built_kernels)
    notes.emplace_back("the time includes building kernels; --repeat 5 tells that of later runs");
  return notes;
}

}  // namespace pliant
