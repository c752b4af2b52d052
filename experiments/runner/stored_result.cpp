#include "experiments/runner/stored_result.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "experiments/report/chart_html.h"
#include "experiments/report/json_table.h"
#include "experiments/report/study_page.h"
#include "experiments/runner/result_folder.h"
#include "experiments/tasks/json_file.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

/// The folder of the whole result: this one, or the one above.
fs::path root_of(const fs::path& folder) {
  if (is_there(folder / ".pliant")) return folder;
  fs::path above = fs::absolute(folder / "x").lexically_normal().parent_path().parent_path();
  if (is_there(folder / "run.json") && is_there(above / ".pliant")) return above;
  throw DataError(folder.string() + (is_there(folder)
                                         ? ": holds no result; expected a folder that pliant run has made"
                                         : ": there is no such folder"));
}

/// Metrics one below the other, at the stages that were measured.
Table stages_table(const ordered_json& run) {
  constexpr std::array<std::pair<const char*, const char*>, 3> stages{
      {{"initial", "initial"}, {"aligned", "aligned"}, {"metrics", "final"}}};
  Table table{"Metrics", {""}, {}};
  for (const auto& [key, title] : stages)
    if (run.contains(key)) table.header.emplace_back(title);
  for (const auto& [name, value] : run.at("metrics").items()) {
    Table::Row row{{name}};
    for (const auto& [key, title] : stages)
      if (run.contains(key))
        row.cells.push_back(run[key].contains(name) ? fmt::format("{:.4g}", run[key][name].get<double>())
                                                    : "–");
    table.rows.push_back(std::move(row));
  }
  table.main_column = table.header.size() - 1;
  return table;
}

/// Of a run that tracked a stream.
Table tracking_table(const ordered_json& run) {
  ordered_json facts;
  for (const char* key : {"frames", "tracked", "lost", "registered", "rejected", "mean_error", "error_mean",
                          "error_sd", "frame_ms"})
    if (run.contains(key)) facts[key] = run[key];
  return facts_table("Tracking", facts);
}

Chart energy_chart(const ordered_json& energy) {
  Series series{"Energy", "iteration", "energy", {energy.at("initial").get<double>()}};
  for (const auto& value : energy.at("per_iteration")) series.values.push_back(value.get<double>());
  return chart_of(series);
}

Chart residual_chart(const ordered_json& history) {
  Series series{"Residual", "outer iteration", "robust residual, mm", {}};
  for (const auto& step : history) series.values.push_back(step.at("robust").get<double>());
  return chart_of(series);
}

Study study_of_run(const ordered_json& run, const fs::path& folder) {
  Study study;
  study.name = study.title = run.at("name").get<std::string>();
  study.tables.push_back(run.contains("metrics") ? stages_table(run) : tracking_table(run));
  for (const auto& [key, title] : {std::pair("counts", "Counts"), std::pair("time_ms", "Time in ms"),
                                   std::pair("solver", "Solver"), std::pair("alignment", "Alignment"),
                                   std::pair("truth", "Truth"), std::pair("focal_length", "Focal length")})
    if (run.contains(key)) study.tables.push_back(facts_table(title, run[key]));
  if (run.contains("energy")) study.charts.push_back(energy_chart(run["energy"]));
  if (run.contains("history")) study.charts.push_back(residual_chart(run["history"]));
  if (run.contains("termination")) study.notes.push_back("ended by " + run["termination"].get<std::string>());
  for (const auto& warning : run.at("warnings"))
    study.notes.push_back("warning: " + warning.get<std::string>());
  if (is_there(folder / "view.json")) study.views.push_back({"In three dimensions", folder / "view.json"});
  return study;
}

/// Tells of the file where it is not what it should be.
template <class Read>
auto read_as(const fs::path& file, Read read) {
  const ordered_json json = read_json(file.string());
  try {
    return read(json);
  } catch (const nlohmann::json::exception& error) {
    throw DataError(fmt::format("{}: is not what pliant run writes: {}", file.string(), error.what()));
  }
}

std::vector<Study> studies_of_result(const fs::path& folder) {
  return read_as(folder / "result.json", [&](const ordered_json& result) {
    std::vector<Study> studies;
    for (const auto& run : result.at("runs")) {
      const fs::path own = folder / run.at("name").get<std::string>();
      studies.push_back(study_of_run(run, is_there(own / "run.json") ? own : folder));
      studies.back().environment = result.at("environment");
    }
    return studies;
  });
}

std::vector<Study> studies_of_run(const fs::path& folder) {
  return read_as(folder / "run.json", [&](const ordered_json& json) {
    return std::vector<Study>{study_of_run(json.at("run"), folder)};
  });
}

}  // namespace

std::vector<Study> stored_studies(const fs::path& folder) {
  return root_of(folder) == folder ? studies_of_result(folder) : studies_of_run(folder);
}

fs::path page_of_result(const fs::path& folder) {
  const fs::path root = root_of(folder);
  fs::path page = fs::absolute(folder / "index.html").lexically_normal();
  if (is_there(page)) return page;
  const std::string title = fs::absolute(folder / "x").lexically_normal().parent_path().filename().string();
  const std::string text =
      make_study_page(title, "Made of the numbers that the run has stored.", stored_studies(folder));
  ResultFolder::add(root, page.lexically_relative(fs::absolute(root).lexically_normal()), text);
  return page;
}

}  // namespace pliant
