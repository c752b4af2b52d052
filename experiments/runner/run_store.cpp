#include "experiments/runner/run_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "experiments/runner/version.h"
#include "experiments/tasks/json_file.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// The experiment of a run without what it shares with the others and without what it is called.
Parameters what_counts(const Parameters& experiment) {
  std::vector<Parameters::Value> values = experiment.values();
  std::erase_if(values, [](const auto& value) {
    return value.name == "name" || value.name == "runs" || value.name == "quick";
  });
  return {experiment.component(), std::move(values)};
}

ordered_json table_json(const Table& table) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : table.rows) rows.push_back(row.cells);
  return {{"title", table.title}, {"header", table.header}, {"rows", rows}};
}

Table table_of(const ordered_json& json) {
  Table table{json.at("title"), json.at("header"), {}};
  for (const auto& row : json.at("rows")) table.rows.push_back({row});
  return table;
}

RunSummary summary_of(const std::string& name, const ordered_json& json) {
  return {name, json.at("run"), table_of(json.at("summary")), json.at("notes"), json.at("failure")};
}

}  // namespace

std::string run_key(const Task& task, const ExperimentRun& run, const DeviceInfo& device, int repeats) {
  const std::string text = fmt::format("{} {} {} {} {} {}", task.result_file(), repeats, build(), device.name,
                                       device.driver, fingerprint(what_counts(run.values)));
  return fmt::format("{:016x}", std::hash<std::string>{}(text));
}

void RunStore::write(const RunSummary& run, const std::string& key, const Files& files) const {
  ordered_json names = ordered_json::array();
  for (const auto& written : files) names.push_back(written.filename().string());
  write_json(file(run.name).string(), {{"schema", 1},
                                       {"key", key},
                                       {"version", version()},
                                       {"commit", commit()},
                                       {"run", run.json},
                                       {"summary", table_json(run.summary)},
                                       {"notes", run.notes},
                                       {"failure", run.failure},
                                       {"files", names}});
}

std::optional<RunSummary> RunStore::find(const std::string& name, const std::string& key) const {
  std::error_code ignored;
  if (!fs::is_regular_file(file(name), ignored)) return {};
  try {
    const ordered_json json = read_json(file(name).string());
    if (json.at("key") != key) return {};
    for (const std::string written : json.at("files")) {
      const bool leads_out = fs::path(written).filename() != written;
      if (leads_out || !fs::is_regular_file(folder_ / name / written, ignored)) return {};
    }
    return summary_of(name, json);
  } catch (const DataError&) {
    return {};
  } catch (const ordered_json::exception&) {
    return {};
  }
}

void RunStore::remove(const std::string& name) const {
  std::error_code ignored;
  fs::remove_all(folder_ / name, ignored);
}

void RunStore::copy_to(const RunStore& other, const std::string& name) const {
  const ordered_json json = read_json(file(name).string());
  const fs::path from = folder_ / name;
  const fs::path to = other.folder_ / name;
  std::error_code error;
  fs::create_directories(to, error);
  ordered_json files = json.at("files");
  files.push_back("run.json");
  for (const std::string copied : files) {
    if (!error) fs::copy_file(from / copied, to / copied, fs::copy_options::overwrite_existing, error);
    if (error)
      throw DataError(fmt::format("{}: cannot be written: {}", (to / copied).string(), error.message()));
  }
}

}  // namespace pliant
