#include "experiments/runner/runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/runner/result_json.h"
#include "framework/core/error.h"
#include "framework/io/file.h"
#include "framework/tracking/register_pair.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& file, const std::string& text) {
  write_file(file.string(), {text.begin(), text.end()});
}

/// Tells of one run, under its own name and not that of its data.
class RunProgress {
 public:
  RunProgress(const ProgressSink& sink, std::string run) : sink_(sink), run_(std::move(run)) {}

  void tell(const std::string& message) const {
    if (sink_) sink_({run_, 1, message});
  }

  /// For the steps of a registration; `label` comes before what they say.
  ProgressSink steps(const std::string& label) const {
    if (!sink_) return {};
    return [this, label](const Progress& step) { sink_({run_, step.done, label + step.message}); };
  }

 private:
  const ProgressSink& sink_;
  std::string run_;
};

template <class Input>
void write_reports(const ExperimentPlan::Run& run, const Input& input, const fs::path& folder,
                   const Registry& registry, const RunProgress& progress) {
  for (const auto& [name, section] : run.values.sections("reports")) {
    progress.tell("writing " + name);
    registry.make<Report>(section)->write(input, folder);
  }
}

/// Makes a result with `make(label)`, or after one that does not count `repeats` of them; they differ only in
/// time, and the median one's is told.
template <class Make>
auto make_timed(Device& device, int repeats, Timing& timing, Make make) {
  struct Times {
    double total_ms;
    StageTimes stages;
  };
  int built = device.programs_built();
  auto result = make(repeats > 0 ? "warm-up, " : "");
  std::vector<Times> times{{result.total_ms, result.time_ms}};
  if (repeats > 0) {
    times.clear();
    built = device.programs_built();
    for (int i = 1; i <= repeats; ++i) {
      const auto again = make(fmt::format("{} of {}, ", i, repeats));
      times.push_back({again.total_ms, again.time_ms});
    }
  }
  std::sort(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.total_ms < b.total_ms; });
  const Times& median = times[(times.size() - 1) / 2];
  result.total_ms = median.total_ms;
  result.time_ms = median.stages;
  timing = {static_cast<int>(times.size()), times.front().total_ms, times.back().total_ms,
            device.programs_built() > built};
  return result;
}

/// Handles cannot give everything that an energy may ask for.
void check_energies(const Method& method, const std::string& place) {
  const auto is_pull = [](const Energy& energy) { return energy.stencil == Stencil::per_constraint; };
  if (std::none_of(method.energies.begin(), method.energies.end(), is_pull))
    throw ConfigError(place +
                      ": no energy draws the surface to the handles; expected 'constraint' among "
                      "the energies");
  for (const Energy& energy : method.energies) {
    if (energy.uses_features())
      throw ConfigError(
          fmt::format("{}: the energy '{}' needs a target to match features with; handles have none", place,
                      energy.equation.name));
  }
}

/// Measures the source before anything, aligned and at the end.
NearestDistances measure(const Evaluation& evaluation, RunRecord& record, const RunProgress& progress) {
  const RegistrationResult& result = record.result;
  const auto nearest = [&](const std::vector<Eigen::Vector3f>& points) {
    return evaluation.nearest(points, [&](double share) {
      progress.tell(fmt::format("measuring distances: {:.0f} %", 100 * share));
    });
  };
  NearestDistances distances;
  distances.initial = nearest(result.source.points);
  const bool is_aligned = result.aligned_points != result.source.points;
  distances.aligned = is_aligned ? nearest(result.aligned_points) : distances.initial;
  distances.final = nearest(result.points);
  record.initial = evaluation.measure(result.source.points, distances.initial);
  record.aligned = evaluation.measure(result.aligned_points, distances.aligned);
  record.metrics = evaluation.measure(result.points, distances.final);
  return distances;
}

RunRecord make_run(const ExperimentPlan::Run& run, const fs::path& folder, Workbench& workbench,
                   const ProgressSink& sink, int repeats) {
  const RunProgress progress(sink, run.name);
  const FramePair& pair = workbench.pair(run.values);
  const Method method = make_method(run, workbench.registry());
  const auto seed = static_cast<std::uint64_t>(run.values.integer("seed"));
  RunRecord record;
  record.name = run.name;
  Device& device = workbench.device(run.values);
  device.measure_stages(true);
  record.result = told_with_place(run.place, pair, [&] {
    return make_timed(device, repeats, record.timing, [&](const std::string& label) {
      return register_pair(pair, method, device, seed, progress.steps(label));
    });
  });
  device.measure_stages(false);
  progress.tell("measuring distances");
  const SurfaceImage target = make_surface_image(device, pair.target, pair.camera);
  const Evaluation evaluation(pair, workbench.truth(run.values), record.result.source, target);
  const NearestDistances nearest = measure(evaluation, record, progress);
  write_reports(run, ReportInput{pair, target, nearest, record}, folder, workbench.registry(), progress);
  return record;
}

EditRecord make_edit(const ExperimentPlan::Run& run, const fs::path& folder, Workbench& workbench,
                     const ProgressSink& sink, int repeats) {
  const FramePair& pair = workbench.pair(run.values);
  const Method method = make_method(run, workbench.registry());
  const NamedHandles handles = make_handles(run, workbench.registry());
  Device& device = workbench.device(run.values);
  device.measure_stages(true);
  EditRecord record;
  record.name = run.name;
  record.result = told_with_place(run.place, pair, [&] {
    return make_timed(device, repeats, record.timing,
                      [&](const std::string&) { return edit_surface(pair, handles, method, device); });
  });
  device.measure_stages(false);
  write_reports(run, EditInput{pair, record}, folder, workbench.registry(), RunProgress(sink, run.name));
  return record;
}

/// Milliseconds, of several runs with the least and the most.
std::string time_text(double total_ms, const Timing& timing) {
  if (timing.repeats == 1) return fmt::format("{:.0f}", total_ms);
  return fmt::format("{:.0f} ({:.0f} to {:.0f})", total_ms, timing.min_ms, timing.max_ms);
}

std::string change(double before, double after) { return fmt::format("{:.2f} -> {:.2f}", before, after); }

bool is_variant(const ExperimentPlan& plan) { return !plan.experiment.values.sections("runs").empty(); }

bool has_page(const ExperimentPlan::Run& run) {
  const auto& reports = run.values.sections("reports");
  return std::any_of(reports.begin(), reports.end(),
                     [](const auto& report) { return report.second.component() == "page"; });
}

/// Makes the folder that a run is written into.
fs::path run_folder(const ExperimentPlan& plan, const ExperimentPlan::Run& run, const fs::path& folder) {
  if (!is_variant(plan)) return folder;
  std::error_code error;
  fs::create_directory(folder / run.name, error);
  if (error)
    throw DataError(fmt::format("{}: cannot be made: {}", (folder / run.name).string(), error.message()));
  return folder / run.name;
}

/// Writes what tells of all runs.
template <class Record>
void write_overview(const ExperimentPlan& plan, const fs::path& folder, const DeviceInfo& device,
                    const std::vector<Record>& records) {
  write_json((folder / "result.json").string(), result_json(plan, device, records));
  if (!is_variant(plan)) return;
  write_text(folder / "index.html",
             make_overview_page(plan.name, "One row a run; each name leads to its page.",
                                {run_table(plan, records)}));
}

/// Makes every run into its folder, then what tells of all of them.
template <class Record, class MakeRun>
std::vector<Record> make_runs(const ExperimentPlan& plan, const fs::path& folder, Workbench& workbench,
                              MakeRun make) {
  ResultFolder result(folder, result_files(plan, workbench.registry()), plan.experiment.files);
  const fs::path& unfinished = result.unfinished();
  std::vector<Record> records;
  try {
    write_experiment(unfinished, plan);
    for (const auto& run : plan.runs) records.push_back(make(run, run_folder(plan, run, unfinished)));
    write_overview(plan, unfinished, workbench.device(plan.experiment.values).info(), records);
  } catch (const Error& error) {
    if (records.empty()) throw;
    throw Error(
        fmt::format("{}; what was finished before is kept in {}", error.what(), result.keep().string()),
        error.exit_code());
  }
  result.commit();
  return records;
}

/// The page of a run, seen from the folder above `folder_name` (empty: from inside it); empty: it has none.
std::string page_of(const ExperimentPlan& plan, std::size_t run, const std::string& folder_name) {
  if (!has_page(plan.runs[run])) return "";
  return (folder_name.empty() ? "" : folder_name + "/") +
         (is_variant(plan) ? plan.runs[run].name + "/index.html" : "index.html");
}

}  // namespace

Method make_method(const ExperimentPlan::Run& run, const Registry& registry) {
  Method method = make_method(run.values, registry);
  if (!run.values.sections("handles").empty()) check_energies(method, run.place);
  return method;
}

NamedHandles make_handles(const ExperimentPlan::Run& run, const Registry& registry) {
  NamedHandles handles;
  for (const auto& [name, section] : run.values.sections("handles"))
    handles.emplace_back(name, *registry.make<Handle>(section));
  return handles;
}

void write_experiment(const fs::path& folder, const ExperimentPlan& plan) {
  write_text(folder / "experiment.yaml", plan.experiment.to_yaml());
}

ResultFolder::Files result_files(const ExperimentPlan& plan, const Registry& registry) {
  ResultFolder::Files files{"experiment.yaml", "result.json"};
  if (is_variant(plan)) files.emplace_back("index.html");
  for (const auto& run : plan.runs)
    for (const auto& [name, section] : run.values.sections("reports"))
      for (const auto& file : registry.make<Report>(section)->files())
        files.push_back(is_variant(plan) ? fs::path(run.name) / file : fs::path(file));
  return files;
}

void check_experiment(const ExperimentPlan& plan, Workbench& workbench) {
  const Registry& registry = workbench.registry();
  for (const auto& run : plan.runs) {
    make_method(run, registry);
    for (const auto& [name, section] : run.values.sections("reports")) registry.make<Report>(section);
    for (const auto& [name, section] : run.values.sections("solvers")) registry.make<Solver>(section);
    const FramePair& pair = workbench.pair(run.values);
    workbench.device(run.values);
    if (!plan.has_handles()) continue;
    const Surface source = told_with_place(run.place, [&] { return source_surface(pair); });
    for (const auto& [name, handle] : make_handles(run, registry)) take_hold(handle, source);
  }
}

std::vector<RunRecord> run_experiment(const ExperimentPlan& plan, const fs::path& folder,
                                      Workbench& workbench, const ProgressSink& progress, int repeats) {
  return make_runs<RunRecord>(plan, folder, workbench, [&](const auto& run, const fs::path& own) {
    return make_run(run, own, workbench, progress, repeats);
  });
}

std::vector<EditRecord> edit_experiment(const ExperimentPlan& plan, const fs::path& folder,
                                        Workbench& workbench, const ProgressSink& progress, int repeats) {
  return make_runs<EditRecord>(plan, folder, workbench, [&](const auto& run, const fs::path& own) {
    return make_edit(run, own, workbench, progress, repeats);
  });
}

void check_ends(const ExperimentPlan& plan, const std::vector<RunRecord>& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].result.termination == "failed")
      throw NumericalError(fmt::format("{}: {}; the result is that of iteration {}", plan.runs[i].place,
                                       runs[i].result.reason, runs[i].result.counts.outer_iterations));
}

Table run_table(const ExperimentPlan& plan, const std::vector<RunRecord>& runs,
                const std::string& folder_name) {
  Table table;
  table.title = plan.name;
  table.header = {"run",         "nodes",      "constraints", "iterations",
                  "residual mm", "nearest mm", "EPE mm",      "time ms"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& run = runs[i];
    const auto& counts = run.result.counts;
    const std::string epe = run.metrics.truth && run.initial.truth
                                ? change(run.initial.truth->epe_mean, run.metrics.truth->epe_mean)
                                : "unknown";
    table.rows.push_back({{run.name, std::to_string(counts.nodes), std::to_string(counts.constraints),
                           std::to_string(counts.outer_iterations),
                           change(run.initial.residual_mean, run.metrics.residual_mean),
                           change(run.initial.nearest_mean, run.metrics.nearest_mean), epe,
                           time_text(run.result.total_ms, run.timing)},
                          page_of(plan, i, folder_name)});
  }
  return table;
}

Table run_table(const ExperimentPlan& plan, const std::vector<EditRecord>& runs,
                const std::string& folder_name) {
  Table table;
  table.title = plan.name;
  table.header = {"run", "nodes", "held points", "iterations", "handles mm", "energy", "time ms"};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const EditResult& result = runs[i].result;
    const auto all = result.all_handles();
    table.rows.push_back(
        {{runs[i].name, std::to_string(result.counts.nodes), std::to_string(result.counts.constraints),
          std::to_string(result.counts.solver_iterations), change(all.initial_mean, all.mean),
          fmt::format("{:.4g} -> {:.4g}", result.energy.initial, result.energy.final),
          time_text(result.total_ms, runs[i].timing)},
         page_of(plan, i, folder_name)});
  }
  return table;
}

}  // namespace pliant
