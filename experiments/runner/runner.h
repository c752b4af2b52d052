#pragma once

#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/report/table.h"
#include "experiments/runner/experiment.h"
#include "experiments/runner/result_folder.h"
#include "experiments/tasks/task.h"
#include "framework/core/log.h"

namespace pliant {

/// What an experiment came to.
struct ExperimentResult {
  struct Failed {
    std::string name;
    std::string message;
    std::exception_ptr error;
  };
  std::vector<RunSummary> runs;  ///< those that were made, in the order of the plan
  std::vector<Failed> failed;    ///< the others
  std::vector<std::string>
      taken;  ///< names of runs that an earlier result had, which did not come to its end
};

/// The names of all files that a task may write of an experiment, relative to its folder.
ResultFolder::Files result_files(const Task& task, const ExperimentPlan& plan, const Registry& registry);

/// Tries everything of an experiment short of the work: makes every component, opens the device, loads the
/// data. Throws what running it would. Gives what is odd about the data of each run, under its name.
std::vector<std::pair<std::string, std::string>> check_experiment(const ExperimentPlan& plan,
                                                                  Workbench& workbench);

/// How an experiment is run.
struct RunOptions {
  int repeats = 0;  ///< see Task::make; 0: as the experiment says
  /// One of many that are made together: runs are also taken from a result that is whole, and where all of
  /// them fail only the result says so, and nothing is written.
  bool is_one_of_many = false;
  std::function<bool()> is_ended = [] { return false; };  ///< see Making
  TrackObserver* observer = nullptr;                      ///< see Making
};

/// What the progress of a run says that is not made but taken.
inline constexpr const char* taken_message = "taken from the earlier result";

/// Makes every run of an experiment, and writes into `folder`: the task's file of numbers, experiment.yaml,
/// and what the reports write, of several runs each into a folder of its own name, with a page over all of
/// them (write_overview).
///
/// A run that fails with an Error keeps no other from being made; where all do, the first one's is thrown and
/// the folder stays as it was. It changes only when all is done (ResultFolder); what else ends this before
/// leaves the finished ones of several runs there, and the next call takes them, as it takes those of a
/// result in which runs failed (RunStore).
ExperimentResult run_experiment(const Task& task, const ExperimentPlan& plan,
                                const std::filesystem::path& folder, Workbench& workbench,
                                const ProgressSink& progress = {}, const RunOptions& options = {});

/// Throws the error of the first run that failed, else DataError or NumericalError for the first whose
/// result is not the one that was asked for.
void check_ends(const ExperimentResult& result);

/// The key figures of each run. Links lead from `folder_name` (empty: from inside the folder).
std::vector<Table> run_tables(const Task& task, const ExperimentPlan& plan, const ExperimentResult& result,
                              const std::string& folder_name = "");

}  // namespace pliant
