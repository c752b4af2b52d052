#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/study/run_row.h"
#include "experiments/tasks/task.h"
#include "framework/config/config.h"

namespace pliant {

/// The keys of an experiment file.
ParameterTable experiment_table();

/// What stands beside the folders of several runs, in results of every kind.
inline constexpr std::array files_beside_runs{"experiment.yaml", "result.json", "compare.json", "results.csv",
                                              "index.html",      "charts",      "unfinished"};

/// A checked experiment and the runs that it asks for.
struct ExperimentPlan {
  std::string name;  ///< of the experiment: its `name`, else that of the file or text
  Experiment experiment;
  std::vector<ExperimentRun> runs;  ///< at least one

  /// Whether its runs have names and folders of their own.
  bool has_variants() const { return !experiment.values.sections("runs").empty(); }

  /// Leaves out the runs that `quick` does not list, where it lists any.
  void keep_quick_runs();
};

/// A row for each run that the experiment asks for, also for those that are not to be made; without numbers
/// where it is none of `runs`.
std::vector<RunRow> study_rows(const ExperimentPlan& plan, const std::vector<RunSummary>& runs);

/// Reads an experiment (see load_experiment). Throws ConfigError with every error of the file, also for
/// names that cannot name a folder.
ExperimentPlan plan_experiment(const ConfigSource& source, const Registry& registry);

}  // namespace pliant
