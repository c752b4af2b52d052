#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/runner/experiment.h"
#include "experiments/runner/result_folder.h"
#include "experiments/runner/table.h"
#include "experiments/runner/workbench.h"
#include "framework/core/log.h"
#include "framework/problem/solver.h"

namespace pliant {

/// What one solver made of the first problem of a run.
struct SolverTrial {
  std::string name;  ///< its label in the experiment
  SolverSummary summary;
  double initial_energy = 0;  ///< this and the next are Problem::energy, whatever the solver says
  double final_energy = 0;
  double relative_difference = 0;  ///< of the final energy to the lowest that any solver found
  double setup_ms = 0;             ///< medians of wall times: binding the solver to the problem,
  double solve_ms = 0;             ///< and solving it to the end
  int repetitions = 0;             ///< that the medians are of
};

/// All solvers on the problem of one run.
struct RunComparison {
  std::string name;
  int nodes = 0;
  int constraints = 0;
  int unknowns = 0;
  std::vector<SolverTrial> trials;
};

/// The names of the files that compare_solvers writes.
ResultFolder::Files compare_files();

/// Freezes the first problem of each run, lets every solver of `solvers` minimise an identical one from the
/// same start, and writes compare.json, index.html and experiment.yaml into `folder`. Throws ConfigError
/// when the experiment lists no solvers, NumericalError when one of them finds no finite answer.
std::vector<RunComparison> compare_solvers(const ExperimentPlan& plan, const std::filesystem::path& folder,
                                           Workbench& workbench, const ProgressSink& progress = {});

/// One table a run.
std::vector<Table> compare_tables(const std::vector<RunComparison>& comparisons);

}  // namespace pliant
