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

void write_reports(const ExperimentPlan::Run& run, const ReportInput& input, const fs::path& folder,
                   const Registry& registry) {
  make_folder(folder);
  for (const auto& [name, section] : run.values.sections("reports"))
    registry.make<Report>(section)->write(input, folder);
}

RunRecord make_run(const ExperimentPlan::Run& run, const fs::path& folder, Workbench& workbench,
                   const ProgressSink& progress) {
  const FramePair& pair = workbench.pair(run.values);
  const Method method = make_method(run.values, workbench.registry());
  RunRecord record;
  record.name = run.name;
  Device& device = workbench.device(run.values);
  device.measure_stages(true);
  record.result = told_with_place(run.place, [&] {
    return register_pair(pair, method, device, static_cast<std::uint64_t>(run.values.integer("seed")),
                         named_progress(progress, run.name));
  });
  device.measure_stages(false);
  const SurfaceMap target = make_surface_map(pair.target, pair.camera);
  const Evaluation evaluation(pair, record.result.source, target);
  record.initial = evaluation.measure(record.result.source.points);
  record.aligned = evaluation.measure(record.result.aligned_points);
  record.metrics = evaluation.measure(record.result.points);
  write_reports(run, {pair, target, evaluation, record}, folder, workbench.registry());
  return record;
}

std::string change(double before, double after) { return fmt::format("{:.2f} -> {:.2f}", before, after); }

bool is_variant(const ExperimentPlan& plan) { return !plan.experiment.values.sections("runs").empty(); }

bool has_page(const ExperimentPlan::Run& run) {
  const auto& reports = run.values.sections("reports");
  return std::any_of(reports.begin(), reports.end(),
                     [](const auto& report) { return report.second.component() == "page"; });
}

}  // namespace

void prepare_folder(const fs::path& folder, const ExperimentPlan& plan) {
  make_folder(folder);
  write_text(folder / "experiment.yaml", plan.experiment.to_yaml());
}

void check_experiment(const ExperimentPlan& plan, Workbench& workbench) {
  const Registry& registry = workbench.registry();
  for (const auto& run : plan.runs) {
    make_method(run.values, registry);
    for (const auto& [name, section] : run.values.sections("reports")) registry.make<Report>(section);
    for (const auto& [name, section] : run.values.sections("solvers")) registry.make<Solver>(section);
    workbench.pair(run.values);
    workbench.device(run.values);
  }
}

std::vector<RunRecord> run_experiment(const ExperimentPlan& plan, const fs::path& folder,
                                      Workbench& workbench, const ProgressSink& progress) {
  prepare_folder(folder, plan);
  std::vector<RunRecord> records;
  for (const auto& run : plan.runs)
    records.push_back(make_run(run, is_variant(plan) ? folder / run.name : folder, workbench, progress));
  write_json((folder / "result.json").string(),
             result_json(plan, workbench.device(plan.experiment.values).info(), records));
  if (is_variant(plan))
    write_text(folder / "index.html",
               make_overview_page(plan.name, "One row a run; each name leads to its page.",
                                  {run_table(plan, records)}));
  return records;
}

Table run_table(const ExperimentPlan& plan, const std::vector<RunRecord>& runs,
                const std::string& folder_name) {
  Table table;
  table.title = plan.name;
  table.header = {"run",         "nodes",      "constraints", "iterations",
                  "residual mm", "nearest mm", "EPE mm",      "time ms"};
  const std::string prefix = folder_name.empty() ? "" : folder_name + "/";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& run = runs[i];
    const auto& counts = run.result.counts;
    const std::string page = is_variant(plan) ? run.name + "/index.html" : "index.html";
    const std::string epe = run.metrics.truth && run.initial.truth
                                ? change(run.initial.truth->epe_mean, run.metrics.truth->epe_mean)
                                : "unknown";
    table.rows.push_back({{run.name, std::to_string(counts.nodes), std::to_string(counts.constraints),
                           std::to_string(counts.outer_iterations),
                           change(run.initial.residual_mean, run.metrics.residual_mean),
                           change(run.initial.nearest_mean, run.metrics.nearest_mean), epe,
                           fmt::format("{:.0f}", run.result.total_ms)},
                          has_page(plan.runs[i]) ? prefix + page : ""});
  }
  return table;
}

}  // namespace pliant
