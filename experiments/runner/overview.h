#pragma once

#include <filesystem>

#include "experiments/report/study.h"
#include "experiments/runner/experiment.h"
#include "experiments/runner/result_folder.h"
#include "experiments/runner/runner.h"

namespace pliant {

/// What the runs of an experiment show together, as its `study` asks for it. `folder`: where the result is.
Study study_of(const ExperimentPlan& plan, const ExperimentResult& result, const DeviceInfo& device,
               const std::filesystem::path& folder);

/// The names of the files that write_overview() may write, relative to the result's folder.
ResultFolder::Files overview_files(const Task& task, const ExperimentPlan& plan);

/// Writes what tells of all runs: the numbers, the experiment and, of several runs, results.csv, the charts
/// and the page over all of them.
void write_overview(const Task& task, const ExperimentPlan& plan, const ExperimentResult& result,
                    const DeviceInfo& device, const std::filesystem::path& folder);

}  // namespace pliant
