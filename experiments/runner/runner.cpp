#include "experiments/runner/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "experiments/report/report.h"
#include "experiments/runner/overview.h"
#include "experiments/runner/run_store.h"
#include "experiments/tasks/json_file.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// Tells of a run under its own name and not that of its data.
ProgressSink under_name(const ProgressSink& sink, const std::string& run) {
  return [&sink, run](const Progress& step) {
    if (sink) sink({run, step.done, step.message});
  };
}

bool has_page(const Task& task, const ExperimentRun& run) {
  const auto& reports = run.values.sections("reports");
  return task.is_reported() && std::any_of(reports.begin(), reports.end(), [](const auto& report) {
           return report.second.component() == "page";
         });
}

/// Makes the runs of an experiment into a folder.
class Runs {
 public:
  Runs(const Task& task, const ExperimentPlan& plan, Workbench& workbench, const ProgressSink& progress,
       const RunOptions& options)
      : task_(task), plan_(plan), workbench_(workbench), progress_(progress), options_(options) {}

  ExperimentResult make(const fs::path& folder) {
    ResultFolder result(folder, result_files(task_, plan_, workbench_.registry()), plan_.experiment.files,
                        plan_.has_variants() ? ResultFolder::Leftovers::stay : ResultFolder::Leftovers::go);
    const RunStore finished(result.unfinished(),
                            options_.is_one_of_many || is_incomplete(folder) ? folder : "");
    if (plan_.has_variants()) result.keep_only(take(finished));
    for (const auto& run : plan_.runs) {
      make_or_take(run, result, finished);
      if (plan_.has_variants() && !made_.runs.empty()) result.keep();
    }
    if (made_.runs.empty() && options_.is_one_of_many) return std::move(made_);
    if (made_.runs.empty()) std::rethrow_exception(made_.failed.front().error);
    write_overview(task_, plan_, made_, workbench_.device(plan_.runs.front().values).info(),
                   result.unfinished());
    result.commit();
    return std::move(made_);
  }

 private:
  std::string key(const ExperimentRun& run) const {
    return run_key(task_, run, workbench_.device(run.values).info(), repeats(run));
  }

  /// How often a run is timed: as the caller says, else as its experiment does.
  int repeats(const ExperimentRun& run) const {
    return options_.repeats > 0 ? options_.repeats : static_cast<int>(run.values.integer("repeat"));
  }

  /// Whether the result in a folder lacks runs that failed.
  bool is_incomplete(const fs::path& folder) const {
    try {
      return read_json((folder / task_.result_file()).string()).contains("failed");
    } catch (const DataError&) {
      return false;
    }
  }

  /// Finds what is finished already; gives its folders.
  ResultFolder::Files take(const RunStore& finished) {
    ResultFolder::Files folders;
    for (const auto& run : plan_.runs) {
      try {
        const auto found = finished.find(run.name, key(run));
        if (!found) continue;
        taken_.emplace(run.name, *found);
        folders.emplace_back(run.name);
      } catch (const Error&) {  // comes again when the run is made
      }
    }
    return folders;
  }

  void make_or_take(const ExperimentRun& run, ResultFolder& result, const RunStore& finished) {
    const auto taken = taken_.find(run.name);
    if (taken != taken_.end()) {
      under_name(progress_, run.name)({"", 1, taken_message});
      made_.runs.push_back(taken->second);
      made_.taken.push_back(run.name);
      return;
    }
    const auto failed = [&](const Error& error) {
      made_.failed.push_back({run.name, error.what(), std::current_exception()});
    };
    if (options_.is_ended()) {
      const DataError ended(run.place + ": it was ended before this run began");
      made_.failed.push_back({run.name, ended.what(), std::make_exception_ptr(ended)});
      return;
    }
    const fs::path own = folder_of(run, result.unfinished());
    std::optional<RunArtefacts> made;
    try {
      made = task_.make(run, workbench_,
                        {under_name(progress_, run.name), repeats(run), own, [&] { result.keep(); },
                         options_.is_ended, options_.observer});
    } catch (const Error& error) {
      remove(run, finished);
      return failed(error);
    }
    try {
      write_run(run, *made, own, finished);
      made_.runs.push_back(std::move(*made));
    } catch (const NumericalError& error) {
      remove(run, finished);
      failed(error);
    } catch (const Error&) {  // what cannot be written ends it all: nor could the others be
      remove(run, finished);
      throw;
    }
  }

  void remove(const ExperimentRun& run, const RunStore& finished) const {
    if (plan_.has_variants()) finished.remove(run.name);
  }

  /// Where the results of a run go; it exists.
  fs::path folder_of(const ExperimentRun& run, const fs::path& folder) const {
    fs::path own = plan_.has_variants() ? folder / run.name : folder;
    std::error_code error;
    fs::create_directories(own, error);
    if (error) throw DataError(fmt::format("{}: cannot be made: {}", own.string(), error.message()));
    return own;
  }

  void write_run(const ExperimentRun& run, const RunArtefacts& made, const fs::path& own,
                 const RunStore& finished) const {
    RunStore::Files files = made.files;
    if (task_.is_reported()) {
      const auto written = write_reports(run, made, own, under_name(progress_, run.name));
      files.insert(files.end(), written.begin(), written.end());
    }
    // What ended early is a result, but not one to go on from.
    if (plan_.has_variants() && !made.has_ended_early) finished.write(made, key(run), files);
  }

  RunStore::Files write_reports(const ExperimentRun& run, const RunArtefacts& made, const fs::path& folder,
                                const ProgressSink& progress) const {
    RunStore::Files files;
    for (const auto& [name, section] : run.values.sections("reports")) {
      progress({"", 1, "writing " + name});
      const auto written = workbench_.registry().make<Report>(section)->write(made, folder);
      files.insert(files.end(), written.begin(), written.end());
    }
    return files;
  }

  const Task& task_;
  const ExperimentPlan& plan_;
  Workbench& workbench_;
  const ProgressSink& progress_;
  const RunOptions& options_;
  std::map<std::string, RunSummary> taken_;
  ExperimentResult made_;
};

/// The page of a run, seen from the folder above `folder_name` (empty: from inside it); empty: it has none.
std::string page_of(const Task& task, const ExperimentPlan& plan, const std::string& run,
                    const std::string& folder_name) {
  const std::string folder = folder_name.empty() ? "" : folder_name + "/";
  if (!task.is_reported()) return folder_name.empty() ? "" : folder + "index.html";
  const auto planned = std::find_if(plan.runs.begin(), plan.runs.end(),
                                    [&](const ExperimentRun& other) { return other.name == run; });
  if (!has_page(task, *planned)) return "";
  return folder + (plan.has_variants() ? run + "/index.html" : "index.html");
}

}  // namespace

ResultFolder::Files result_files(const Task& task, const ExperimentPlan& plan, const Registry& registry) {
  ResultFolder::Files files = overview_files(task, plan);
  for (const auto& run : plan.runs) {
    const fs::path folder = plan.has_variants() ? run.name : "";
    if (plan.has_variants()) files.push_back(folder / "run.json");
    for (const auto& file : task.names().files) files.push_back(folder / file);
    if (!task.is_reported()) continue;
    for (const auto& [name, section] : run.values.sections("reports"))
      for (const auto& file : registry.make<Report>(section)->files(task.names()))
        files.push_back(folder / file);
  }
  return files;
}

std::vector<std::pair<std::string, std::string>> check_experiment(const ExperimentPlan& plan,
                                                                  Workbench& workbench) {
  std::vector<std::pair<std::string, std::string>> warnings;
  const auto task = make_task(plan.experiment.values);
  for (const auto& run : plan.runs) {
    for (const auto& [name, section] : run.values.sections("reports"))
      workbench.registry().make<Report>(section);
    for (const auto& [name, section] : run.values.sections("solvers"))
      workbench.registry().make<Solver>(section);
    for (const auto& warning : task->check(run, workbench)) warnings.emplace_back(run.name, warning);
  }
  return warnings;
}

ExperimentResult run_experiment(const Task& task, const ExperimentPlan& plan, const fs::path& folder,
                                Workbench& workbench, const ProgressSink& progress,
                                const RunOptions& options) {
  return Runs(task, plan, workbench, progress, options).make(folder);
}

void check_ends(const ExperimentResult& result) {
  if (!result.failed.empty()) std::rethrow_exception(result.failed.front().error);
  for (const auto& run : result.runs) {
    if (run.failure.empty()) continue;
    if (run.is_short_of_data) throw DataError(run.failure);
    throw NumericalError(run.failure);
  }
}

std::vector<Table> run_tables(const Task& task, const ExperimentPlan& plan, const ExperimentResult& result,
                              const std::string& folder_name) {
  std::vector<Table> tables;
  for (const auto& run : result.runs) {
    Table table = run.summary;
    if (table.title.empty()) table.title = plan.name;
    for (auto& row : table.rows) row.link = page_of(task, plan, run.name, folder_name);
    if (!tables.empty() && tables.back().title == table.title && tables.back().header == table.header)
      tables.back().rows.insert(tables.back().rows.end(), table.rows.begin(), table.rows.end());
    else
      tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace pliant
