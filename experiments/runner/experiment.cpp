#include "experiments/runner/experiment.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/datasets/frame_source.h"
#include "experiments/report/report.h"
#include "framework/config/config_reader.h"
#include "framework/config/config_sweep.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"
#include "framework/registration/handle.h"
#include "framework/tracking/method.h"

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

void check_quick(const ExperimentPlan& plan, const std::string& file) {
  std::vector<std::string> names;
  for (const auto& run : plan.runs) names.push_back(run.name);
  for (const auto& name : plan.experiment.values.words("quick")) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw ConfigError(fmt::format("{}: 'quick' lists '{}', which is no run; expected {}{}", file, name,
                                  fmt::join(names, ", "), suggestion(name, names)));
  }
}

/// Handles are needed by all runs or by none: what is written of a bent surface is not what is written of a
/// registered one.
void check_handles(const ExperimentPlan& plan) {
  for (const auto& run : plan.runs) {
    if (run.values.sections("handles").empty() != plan.experiment.values.sections("handles").empty())
      throw ConfigError(run.place + ": the run has handles, the experiment has none; expected them in both");
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
  for (auto& row : method_rows()) rows.push_back(std::move(row));
  rows.push_back(components("reports", Report::kind).optional().doc("what is written about each run"));
  rows.push_back(
      overrides("runs").swept_by("sweep").doc("variants that are run instead of the experiment itself"));
  rows.push_back(components("solvers", Solver::kind)
                     .optional()
                     .doc("what `pliant compare` lets solve the first problem of each run"));
  rows.push_back(group("compare", compare_table()).doc("how `pliant compare` measures"));
  rows.push_back(words("quick").optional().doc("runs that `pliant reproduce --quick` makes; all by default"));
  return ParameterTable(std::move(rows));
}

void ExperimentPlan::keep_quick_runs() {
  const auto& quick = experiment.values.words("quick");
  if (quick.empty()) return;
  std::erase_if(runs, [&](const ExperimentRun& run) {
    return std::find(quick.begin(), quick.end(), run.name) == quick.end();
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
  check_handles(plan);
  return plan;
}

}  // namespace pliant
