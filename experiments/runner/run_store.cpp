#include "experiments/runner/run_store.h"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <string_view>

#include "experiments/runner/result_folder.h"
#include "experiments/runner/version.h"
#include "experiments/tasks/json_file.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* file_name = "run.json";

/// The experiment of a run without what it shares with the others, what it is called and how it is shown with
/// them.
Parameters what_counts(const Parameters& experiment) {
  std::vector<Parameters::Value> values = experiment.values();
  std::erase_if(values, [](const auto& value) {
    return value.name == "name" || value.name == "runs" || value.name == "quick" || value.name == "study" ||
           value.name == "repeat";
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

/// Tells a file from one that is torn or was edited. Throws DataError when it cannot be read.
std::string mark_of(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = read_file(file.string());
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return fmt::format("{} {:016x}", bytes.size(), std::hash<std::string_view>{}(text));
}

struct Stored {
  RunSummary run;
  std::vector<std::string> files;
};

/// The run whose folder this is; nothing where it is not whole or came of anything else.
std::optional<Stored> read_run(const fs::path& folder, const std::string& key) {
  try {
    const ordered_json json = read_json((folder / file_name).string());
    if (json.at("key") != key) return {};
    std::vector<std::string> files;
    for (const auto& [name, mark] : json.at("files").items()) {
      if (leads_out(name) || mark_of(folder / name) != mark) return {};
      files.push_back(name);
    }
    return Stored{{folder.filename().string(), json.at("run"), table_of(json.at("summary")), json.at("notes"),
                   json.at("failure"), json.at("is_short_of_data")},
                  files};
  } catch (const DataError&) {                // not there, or torn
  } catch (const ordered_json::exception&) {  // of another kind
  }
  return {};
}

void copy_run(const fs::path& from, const fs::path& to, std::vector<std::string> files) {
  std::error_code error;
  fs::remove_all(to, error);
  fs::create_directories(to, error);
  files.emplace_back(file_name);
  for (const std::string& file : files) {
    if (!error) fs::create_directories((to / file).parent_path(), error);
    if (!error) fs::copy_file(from / file, to / file, error);
    if (error)
      throw DataError(fmt::format("{}: cannot be written: {}", (to / file).string(), error.message()));
  }
}

}  // namespace

std::string run_key(const Task& task, const ExperimentRun& run, const DeviceInfo& device, int repeats) {
  const std::string text = fmt::format("{} {} {} {} {} {}", task.result_file(), repeats, build(), device.name,
                                       device.driver, fingerprint(what_counts(run.values)));
  return fmt::format("{:016x}", std::hash<std::string>{}(text));
}

void RunStore::write(const RunSummary& run, const std::string& key, const Files& files) const {
  auto marks = ordered_json::object();
  for (const auto& written : files)
    marks[written.lexically_relative(folder_ / run.name).string()] = mark_of(written);
  write_json((folder_ / run.name / file_name).string(), {{"schema", 1},
                                                         {"key", key},
                                                         {"version", version()},
                                                         {"commit", commit()},
                                                         {"run", run.json},
                                                         {"summary", table_json(run.summary)},
                                                         {"notes", run.notes},
                                                         {"failure", run.failure},
                                                         {"is_short_of_data", run.is_short_of_data},
                                                         {"files", marks}});
}

std::optional<RunSummary> RunStore::find(const std::string& name, const std::string& key) const {
  auto stored = read_run(folder_ / name, key);
  if (!stored && !last_.empty() && (stored = read_run(last_ / name, key)))
    copy_run(last_ / name, folder_ / name, stored->files);
  return stored ? std::optional(stored->run) : std::nullopt;
}

void RunStore::remove(const std::string& name) const {
  std::error_code ignored;
  fs::remove_all(folder_ / name, ignored);
}

}  // namespace pliant
