#include "experiments/program/commands.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "experiments/program/folders.h"
#include "experiments/program/interruption.h"
#include "experiments/program/live_view.h"
#include "experiments/program/output.h"
#include "experiments/program/progress_line.h"
#include "experiments/runner/components.h"
#include "experiments/runner/runner.h"
#include "framework/config/schema.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

Registry all_components() {
  Registry registry;
  register_everything(registry);
  return registry;
}

fs::path out_folder(const ExperimentOptions& options, const ExperimentPlan& plan) {
  return options.out.empty() ? fs::path("out") / plan.name : fs::path(options.out);
}

void tell(const Task& task, const ExperimentPlan& plan, const ExperimentResult& result,
          const fs::path& folder) {
  for (const auto& table : run_tables(task, plan, result)) print("{}\n", to_text(table));
  for (const auto& run : result.runs)
    for (const auto& note : run.notes) print("{}: {}\n", run.name, note);
  for (const auto& failed : result.failed) print("{}: failed: {}\n", failed.name, failed.message);
  if (!result.taken.empty())
    write_output(fmt::format("Taken from the earlier result, which was not finished: {}\n",
                             fmt::join(result.taken, ", ")));
  print("Results are in {}\n", folder.string());
}

/// Makes an experiment and tells what came of it.
void make(const Task& task, const ExperimentPlan& plan, const ExperimentOptions& options,
          const Registry& registry) {
  const fs::path folder = out_folder(options, plan);
  Workbench workbench(registry, show_line);
  ProgressLine line;
  std::optional<FinishOnInterruption> interruption;
  RunOptions how{options.repeats};
  if (task.can_end_early()) how.is_ended = [&asked = interruption.emplace()] { return asked.is_asked(); };
  std::optional<LiveView> live;
  if (options.show) {
    how.observer = &live.emplace(how.is_ended);
    how.is_ended = [asked = how.is_ended, &live] { return asked() || live->is_closed(); };
  }
  const ExperimentResult result = run_experiment(task, plan, folder, workbench, line.sink(), how);
  line.clear();
  tell(task, plan, result, folder);
  check_ends(result);
}

}  // namespace

ConfigSource config_source(const ExperimentOptions& options) {
  return {options.file, options.sets, data_folders(options.data), {experiments_folder()}};
}

void run_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  const ExperimentPlan plan = plan_experiment(config_source(options), registry);
  make(*make_task(plan.experiment.values), plan, options, registry);
}

void track_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  const ExperimentPlan plan = plan_experiment(config_source(options), registry);
  if (!plan.experiment.values.has("model"))
    throw ConfigError(options.file +
                      ": there is no model to track against; expected a key 'model', as in model: tsdf");
  make(*make_track_task(), plan, options, registry);
}

void check_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  const ExperimentPlan plan = plan_experiment(config_source(options), registry);
  Workbench workbench(registry);
  for (const auto& [run, warning] : check_experiment(plan, workbench))
    print("{}: warning: {}\n", run, warning);
  print("{}: good; it makes {} run{}:", options.file, plan.runs.size(), plan.runs.size() == 1 ? "" : "s");
  for (const auto& run : plan.runs) print(" {}", run.name);
  print("\n");
}

void compare_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  make(*make_compare_task(), plan_experiment(config_source(options), registry), options, registry);
}

void components_command(const std::string& kind, const std::string& name, bool as_json) {
  const Registry registry = all_components();
  if (as_json) {
    print("{}\n", json_schema(experiment_table(), registry).dump(2));
    return;
  }
  const std::string list = list_components(registry, kind);
  if (name.empty()) {
    print("{}", list);
    return;
  }
  const ComponentInfo* info = registry.find(kind, name);
  if (info == nullptr) {
    std::vector<std::string> names;
    for (const auto* component : registry.components(kind)) names.push_back(component->name);
    throw ConfigError(fmt::format("unknown {} '{}'; expected one of {}{}", kind, name, fmt::join(names, ", "),
                                  suggestion(name, names)));
  }
  print("{}", describe(*info));
}

void devices_command() {
  const auto devices = Device::list();
  if (devices.empty()) throw DeviceError(Device::why_none());
  for (const auto& device : devices)
    print("{}\n  {}, {} compute units, {} MiB\n  {}; {}; driver {}\n", device.name,
          device.is_gpu ? "GPU" : "CPU", device.compute_units, device.memory_bytes >> 20, device.platform,
          device.version, device.driver);
}

}  // namespace pliant
