#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/timing.h"
#include "framework/registration/nonrigid_result.h"

namespace pliant {

// What is told alike of every result that came of minimising energies over a deformation graph.

nlohmann::ordered_json counts_json(const NonRigidResult::Counts& counts);
nlohmann::ordered_json energy_json(const NonRigidResult::Energy& energy);
nlohmann::ordered_json solver_json(const NonRigidResult::SolverRecord& solver);

Table counts_table(const NonRigidResult::Counts& counts);
/// `step`: what the energy is told after.
Series energy_series(const NonRigidResult::Energy& energy, const std::string& step);

/// "0.50 -> 0.25"
std::string change(double before, double after);
/// How a run ended, its warnings, and what to know of its time.
std::vector<std::string> notes_of(const std::string& ending, const std::vector<std::string>& warnings,
                                  const Timing& timing);

}  // namespace pliant
