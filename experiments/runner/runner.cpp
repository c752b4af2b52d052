#include "experiments/runner/runner.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/runner/result_json.h"
#include "framework/core/error.h"
#include "framework/io/file.h"
#include "framework/registration/registration.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error))
    throw DataError(fmt::format("{}: the output folder cannot be made: {}", folder.string(),
                                error ? error.message() : "there is a file of this name"));
}

void write_text(const fs::path& file, const std::string& text) {
  write_file(file.string(), {text.begin(), text.end()});
}

/// Progress under the name of the run, not of its data.
ProgressSink named_progress(const ProgressSink& progress, const std::string& name) {
  if (!progress) return {};
  return [progress, name](const Progress& step) { progress({name, step.done, step.message}); };
}

template <class Input>
void write_reports(const ExperimentPlan::Run& run, const Input& input, const fs::path& folder,
                   const Registry& registry) {
  make_folder(folder);
  for (const auto& [name, section] : run.values.sections("reports"))
    registry.make<Report>(section)->write(input, folder);
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

RunRecord make_run(const ExperimentPlan::Run& run, const fs::path& folder, Workbench& workbench,
                   const ProgressSink& progress) {
  const FramePair& pair = workbench.pair(run.values);
  const Method method = make_method(run, workbench.registry());
  RunRecord record;
  record.name = run.name;
  Device& device = workbench.device(run.values);
  device.measure_stages(true);
  record.result = told_with_place(run.place, pair, [&] {
    return register_pair(pair, method, device, static_cast<std::uint64_t>(run.values.integer("seed")),
                         named_progress(progress, run.name));
  });
  device.measure_stages(false);
  const SurfaceMap target = make_surface_map(pair.target, pair.camera);
  const Evaluation evaluation(pair, record.result.source, target);
  record.initial = evaluation.measure(record.result.source.points);
  record.aligned = evaluation.measure(record.result.aligned_points);
  record.metrics = evaluation.measure(record.result.points);
  write_reports(run, ReportInput{pair, target, evaluation, record}, folder, workbench.registry());
  return record;
}

EditRecord make_edit(const ExperimentPlan::Run& run, const fs::path& folder, Workbench& workbench) {
  const FramePair& pair = workbench.pair(run.values);
  const Method method = make_method(run, workbench.registry());
  const NamedHandles handles = make_handles(run, workbench.registry());
  Device& device = workbench.device(run.values);
  device.measure_stages(true);
  EditRecord record{run.name, told_with_place(run.place, pair,
                                              [&] { return edit_surface(pair, handles, method, device); })};
  device.measure_stages(false);
  write_reports(run, EditInput{pair, record}, folder, workbench.registry());
  return record;
}

std::string change(double before, double after) { return fmt::format("{:.2f} -> {:.2f}", before, after); }

bool is_variant(const ExperimentPlan& plan) { return !plan.experiment.values.sections("runs").empty(); }

bool has_page(const ExperimentPlan::Run& run) {
  const auto& reports = run.values.sections("reports");
  return std::any_of(reports.begin(), reports.end(),
                     [](const auto& report) { return report.second.component() == "page"; });
}

/// Makes every run into its folder, then what tells of all of them.
template <class Record, class MakeRun>
std::vector<Record> make_runs(const ExperimentPlan& plan, const fs::path& folder, Workbench& workbench,
                              MakeRun make) {
  prepare_folder(folder, plan);
  std::vector<Record> records;
  for (const auto& run : plan.runs)
    records.push_back(make(run, is_variant(plan) ? folder / run.name : folder));
  write_json((folder / "result.json").string(),
             result_json(plan, workbench.device(plan.experiment.values).info(), records));
  if (is_variant(plan))
    write_text(folder / "index.html",
               make_overview_page(plan.name, "One row a run; each name leads to its page.",
                                  {run_table(plan, records)}));
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

void prepare_folder(const fs::path& folder, const ExperimentPlan& plan) {
  make_folder(folder);
  write_text(folder / "experiment.yaml", plan.experiment.to_yaml());
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
                                      Workbench& workbench, const ProgressSink& progress) {
  return make_runs<RunRecord>(plan, folder, workbench, [&](const auto& run, const fs::path& own) {
    return make_run(run, own, workbench, progress);
  });
}

std::vector<EditRecord> edit_experiment(const ExperimentPlan& plan, const fs::path& folder,
                                        Workbench& workbench) {
  return make_runs<EditRecord>(plan, folder, workbench, [&](const auto& run, const fs::path& own) {
    return make_edit(run, own, workbench);
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
                           fmt::format("{:.0f}", run.result.total_ms)},
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
          fmt::format("{:.0f}", result.total_ms)},
         page_of(plan, i, folder_name)});
  }
  return table;
}

}  // namespace pliant
