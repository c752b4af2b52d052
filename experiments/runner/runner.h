#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/report/report.h"
#include "experiments/runner/experiment.h"
#include "experiments/runner/result_folder.h"
#include "experiments/runner/table.h"
#include "experiments/runner/workbench.h"
#include "framework/core/log.h"
#include "framework/tracking/method.h"

namespace pliant {

/// Writes `experiment.yaml`, the whole experiment with every default, which stands alone and loads again.
void write_experiment(const std::filesystem::path& folder, const ExperimentPlan& plan);

/// The names of all files that running an experiment may write, relative to its folder.
ResultFolder::Files result_files(const ExperimentPlan& plan, const Registry& registry);

/// Tries everything of an experiment short of registering: makes every component, opens the device, loads
/// the data. Throws what running it would.
void check_experiment(const ExperimentPlan& plan, Workbench& workbench);

/// Makes every run of an experiment, and writes into `folder`: result.json, experiment.yaml, and what the
/// reports write, of several runs each into a folder of its own name, with an index.html that leads there.
/// With `repeats` above 0 each run is made once untimed, then so many times, and the median time is told.
/// The folder changes only when all is done (ResultFolder); an error after runs that were finished tells
/// where these are kept.
std::vector<RunRecord> run_experiment(const ExperimentPlan& plan, const std::filesystem::path& folder,
                                      Workbench& workbench, const ProgressSink& progress = {},
                                      int repeats = 0);

/// The same for an experiment with handles (ExperimentPlan::has_handles), which run_experiment does not take.
std::vector<EditRecord> edit_experiment(const ExperimentPlan& plan, const std::filesystem::path& folder,
                                        Workbench& workbench, const ProgressSink& progress = {},
                                        int repeats = 0);

/// The method of a run. Throws ConfigError for a combination that makes no sense, also of energies and
/// handles.
Method make_method(const ExperimentPlan::Run& run, const Registry& registry);

/// The handles of a run, by name.
NamedHandles make_handles(const ExperimentPlan::Run& run, const Registry& registry);

/// Throws NumericalError naming the place of the first run that failed; its result is that of the iteration
/// before.
void check_ends(const ExperimentPlan& plan, const std::vector<RunRecord>& runs);

/// The key figures of each run. Links lead from `folder_name` (empty: from inside the folder).
Table run_table(const ExperimentPlan& plan, const std::vector<RunRecord>& runs,
                const std::string& folder_name = "");
Table run_table(const ExperimentPlan& plan, const std::vector<EditRecord>& runs,
                const std::string& folder_name = "");

}  // namespace pliant
