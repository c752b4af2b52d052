#include "experiments/runner/experiment.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/datasets/frame_source.h"
#include "experiments/report/report.h"
#include "experiments/study/study_section.h"
#include "experiments/view/augmentation_section.h"
#include "framework/config/config_reader.h"
#include "framework/config/config_sweep.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"
#include "framework/registration/handle.h"
#include "framework/tracking/method.h"
#include "framework/tracking/tracking_method.h"

namespace pliant {
namespace {

/// Results are kept in folders of these names, so they must be fit for one.
void check_name(const std::string& name, const std::string& place, const std::string& what) {
  const bool is_good =
      !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), is_of_folder_name);
  if (is_good) return;
  throw ConfigError(
      fmt::format("{}: {} '{}' cannot name a folder; expected letters, digits, spaces and the signs "
                  "_ - . + = , ( ) [ ] @ ~ !",
                  place, what, name));
}

/// The name that a file, or the name of a text, gives: what a folder cannot be named with, or JSON cannot
/// hold, becomes "_".
std::string name_of(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  const bool is_text = is_utf8(name);
  for (char& letter : name) {
    const auto byte = static_cast<unsigned char>(letter);
    if (!is_of_folder_name(byte) || (byte >= 0x80 && !is_text)) letter = '_';
  }
  if (name.empty()) return "_";
  if (name.front() == '.') name.front() = '_';
  return name;
}

/// The folder of a run lies beside these files of the whole result. Throws with a line for each run.
void check_run_names(const Parameters::Sections& runs) {
  std::string problems;
  for (const auto& [name, values] : runs) {
    check_name(name, values.place(), "the run's name");
    if (std::find(files_beside_runs.begin(), files_beside_runs.end(), name) == files_beside_runs.end())
      continue;
    problems +=
        fmt::format("{}{}: a run cannot be called '{}', as a file of the result is; expected another name",
                    problems.empty() ? "" : "\n", values.place(), name);
  }
  if (!problems.empty()) throw ConfigError(problems);
}

/// Whether a run is one of those that an entry of `quick` means: it has all of its parts, in any order.
bool is_meant(const std::string& entry, const std::string& run) {
  const std::vector<SweptValue> parts = swept_values(run);
  const std::vector<SweptValue> wanted = swept_values(entry);
  return std::all_of(wanted.begin(), wanted.end(), [&](const SweptValue& value) {
    return std::find(parts.begin(), parts.end(), value) != parts.end();
  });
}

void check_quick(const ExperimentPlan& plan, const std::string& file) {
  std::vector<std::string> names;
  for (const auto& run : plan.runs) names.push_back(run.name);
  for (const auto& entry : plan.experiment.values.words("quick")) {
    if (std::any_of(names.begin(), names.end(), [&](const auto& name) { return is_meant(entry, name); }))
      continue;
    throw ConfigError(fmt::format("{}: 'quick' lists '{}', which is no run; expected {}{}", file, entry,
                                  fmt::join(names, ", "), suggestion(entry, names)));
  }
}

/// Handles, or a model, are needed by all runs or by none: what is written of a bent surface, or of a tracked
/// stream, is not what is written of a registered pair.
void check_tasks(const ExperimentPlan& plan) {
  const Parameters& experiment = plan.experiment.values;
  for (const auto& run : plan.runs) {
    if (run.values.sections("handles").empty() != experiment.sections("handles").empty())
      throw ConfigError(run.place + ": the run has handles, the experiment has none; expected them in both");
    if (run.values.has("model") != experiment.has("model"))
      throw ConfigError(run.place + ": the run has a model, the experiment has none; expected one in both");
  }
}

/// The experiment says its own name also where the file left it to the file's name, so that what is written
/// beside the results is the same experiment.
void name_experiment(ExperimentPlan& plan, const ConfigSource& source) {
  const Parameters& values = plan.experiment.values;
  plan.name = values.has("name") ? values.text("name") : name_of(source.name());
  if (values.has("name")) return;
  nlohmann::ordered_json named = {{"name", plan.name}};
  named.update(plan.experiment.tree);
  plan.experiment.tree = std::move(named);
}

}  // namespace

ParameterTable experiment_table() {
  std::vector<Parameter> rows{
      text("name").optional().doc("of the experiment; the file's name by default"),
      integer("seed", 1).range(0, 4294967295.0).doc("of everything that is drawn at random"),
      text("device", "any").doc("OpenCL device: any, cpu, gpu, or a part of its name"),
      group("kernels", kernels_table()).doc("how kernels are shaped for the device"),
      component("data", FrameSource::kind).doc("what is registered"),
  };
  rows.push_back(components("handles", Handle::kind)
                     .optional()
                     .at_least(1)
                     .doc("bend the source by these handles instead of registering it to the target"));
  for (auto& row : tracking_rows()) rows.push_back(std::move(row));
  rows.push_back(
      group("record", record_table()).optional().doc("what is kept of frames that are tracked, to look at"));
  rows.push_back(
      group("augmentation", augmentation_table())
          .optional()
          .doc("a virtual object over the colour of frames that are tracked, where someone watches"));
  for (auto& row : method_rows()) rows.push_back(std::move(row));
  rows.push_back(components("reports", Report::kind)
                     .optional()
                     .by_default({"surfaces", "pictures", "page"})
                     .doc("what is written about each run; {} for nothing"));
  rows.push_back(
      overrides("runs").swept_by("sweep").doc("variants that are run instead of the experiment itself"));
  rows.push_back(components("solvers", Solver::kind)
                     .optional()
                     .doc("what `pliant compare` lets solve the first problem of each run"));
  rows.push_back(group("compare", compare_table()).doc("how `pliant compare` measures"));
  rows.push_back(
      integer("repeat", 0)
          .range(0, 1000)
          .doc("times so many runs after one that is not timed, and tells the median; `--repeat` wins"));
  rows.push_back(
      words("quick").optional().doc("runs that `pliant reproduce --quick` makes, by their names or parts of "
                                    "them, as in set=1,seed=1; all by "
                                    "default"));
  rows.push_back(group("study", study_table()).doc("how the runs are shown together"));
  return ParameterTable(std::move(rows));
}

std::vector<RunRow> study_rows(const ExperimentPlan& plan, const std::vector<RunSummary>& runs) {
  const auto json_of = [&](const std::string& name) {
    const auto found =
        std::find_if(runs.begin(), runs.end(), [&](const RunSummary& run) { return run.name == name; });
    return found == runs.end() ? nlohmann::ordered_json::object() : found->json;
  };
  std::vector<RunRow> rows;
  for (const auto& [name, values] : plan.experiment.values.sections("runs"))
    rows.push_back(make_run_row(name, json_of(name)));
  if (rows.empty()) rows.push_back(make_run_row(plan.name, json_of(plan.name)));
  return rows;
}

void ExperimentPlan::keep_quick_runs() {
  const auto& quick = experiment.values.words("quick");
  if (quick.empty()) return;
  std::erase_if(runs, [&](const ExperimentRun& run) {
    return std::none_of(quick.begin(), quick.end(),
                        [&](const auto& entry) { return is_meant(entry, run.name); });
  });
}

ExperimentPlan plan_experiment(const ConfigSource& source, const Registry& registry) {
  ExperimentPlan plan;
  plan.experiment = load_experiment(source, experiment_table(), registry);
  name_experiment(plan, source);
  const std::string file = source.name();
  check_name(plan.name, file, "the experiment's name");
  check_run_names(plan.experiment.values.sections("runs"));
  for (const auto& [name, values] : plan.experiment.values.sections("runs"))
    plan.runs.push_back({name, values, file + ", run " + name});
  if (plan.runs.empty()) plan.runs.push_back({plan.name, plan.experiment.values, file});
  for (const auto& run : plan.runs) device_options(run.values);
  check_quick(plan, file);
  make_study(plan.experiment.values.section("study"), study_rows(plan, {}));
  check_tasks(plan);
  return plan;
}

}  // namespace pliant
