#include "experiments/runner/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "experiments/report/chart_svg.h"
#include "experiments/report/study_page.h"
#include "experiments/runner/result_json.h"
#include "experiments/runner/run_frames.h"
#include "experiments/study/study_section.h"
#include "experiments/tasks/json_file.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr const char* charts_folder = "charts";

void write_text(const fs::path& file, const std::string& text) {
  write_file(file.string(), {text.begin(), text.end()});
}

const Parameters& study_section(const ExperimentPlan& plan) {
  return plan.experiment.values.section("study");
}

/// Whether the experiment says anything of how its runs are shown together.
bool has_study(const ExperimentPlan& plan) {
  const Parameters& section = study_section(plan);
  return section.has("title") || std::any_of(study_parts.begin(), study_parts.end(), [&](const char* part) {
           return !section.sections(part).empty();
         });
}

Table failures(const ExperimentResult& result) {
  Table table{"Failed", {"run", "why"}, {}};
  for (const auto& failed : result.failed) table.rows.push_back({{failed.name, failed.message}});
  return table;
}

/// Which runs are missing, and why.
std::vector<std::string> missing(const ExperimentPlan& plan, const ExperimentResult& result) {
  std::vector<std::string> notes;
  for (const auto& failed : result.failed)
    notes.push_back(fmt::format("The run {} failed: {}", failed.name, failed.message));
  const std::size_t wanted = std::max<std::size_t>(plan.experiment.values.sections("runs").size(), 1);
  if (plan.runs.size() < wanted)
    notes.push_back(fmt::format("The quick form: {} of {} runs", plan.runs.size(), wanted));
  return notes;
}

fs::path chart_file(const std::string& name) { return fs::path(charts_folder) / (name + ".svg"); }

void write_charts(const Study& study, const fs::path& folder) {
  if (study.charts.empty()) return;
  std::error_code error;
  fs::create_directories(folder / charts_folder, error);
  if (error)
    throw DataError(
        fmt::format("{}: cannot be made: {}", (folder / charts_folder).string(), error.message()));
  for (const Chart& chart : study.charts) write_text(folder / chart_file(chart.name), chart_svg_file(chart));
}

}  // namespace

Study study_of(const ExperimentPlan& plan, const ExperimentResult& result, const DeviceInfo& device,
               const fs::path& folder) {
  const auto folder_of = [&](const std::string& run) { return plan.has_variants() ? folder / run : folder; };
  Study study =
      make_study(study_section(plan), study_rows(plan, result.runs),
                 [&, known = std::map<std::string, std::vector<Numbers>>()](const RunRow& row) mutable {
                   const auto [found, is_new] = known.try_emplace(row.name);
                   if (is_new && !row.numbers.empty()) found->second = read_run_frames(folder_of(row.name));
                   return found->second;
                 });
  study.name = plan.name;
  if (study.title.empty()) study.title = plan.name;
  for (ShownView& view : study.views) view.file = folder / view.file;
  for (PictureFigure& figure : study.pictures) {
    for (auto& shown : figure.pictures) shown.file = folder / shown.file;
    std::erase_if(figure.pictures, [](const auto& shown) { return !fs::exists(shown.file); });
  }
  std::erase_if(study.pictures, [](const PictureFigure& figure) { return figure.pictures.empty(); });
  std::erase_if(study.views, [](const ShownView& view) { return !fs::exists(view.file); });
  const std::vector<std::string> notes = missing(plan, result);
  study.notes.insert(study.notes.begin(), notes.begin(), notes.end());
  study.experiment = plan.experiment.to_yaml();
  study.environment = environment_json(device, plan);
  return study;
}

ResultFolder::Files overview_files(const Task& task, const ExperimentPlan& plan) {
  ResultFolder::Files files{"experiment.yaml", task.result_file()};
  if (plan.has_variants()) files.emplace_back("results.csv");
  if (plan.has_variants() || !task.is_reported()) files.emplace_back("index.html");
  for (const auto& [name, chart] : study_section(plan).sections("charts")) files.push_back(chart_file(name));
  return files;
}

void write_overview(const Task& task, const ExperimentPlan& plan, const ExperimentResult& result,
                    const DeviceInfo& device, const fs::path& folder) {
  write_text(folder / "experiment.yaml", plan.experiment.to_yaml());
  write_json((folder / task.result_file()).string(), result_json(plan, device, result));
  if (plan.has_variants())
    write_text(folder / "results.csv", to_csv(all_numbers(study_rows(plan, result.runs))));
  std::vector<Table> tables = run_tables(task, plan, result);
  if (has_study(plan)) {
    Study study = study_of(plan, result, device, folder);
    write_charts(study, folder);
    study.tables.insert(study.tables.end(), tables.begin(), tables.end());
    if (plan.has_variants())
      write_text(folder / "index.html", make_study_page(study.title, task.lead(), {study}));
  } else if (plan.has_variants() || !task.is_reported()) {
    if (!result.failed.empty()) tables.push_back(failures(result));
    write_text(folder / "index.html", make_overview_page(plan.name, task.lead(), tables));
  }
}

}  // namespace pliant
