#include "experiments/program/commands.h"

#include <fmt/format.h>

#include <filesystem>

#include "experiments/program/folders.h"
#include "experiments/program/output.h"
#include "experiments/program/progress_line.h"
#include "experiments/runner/compare.h"
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

void tell_time(const std::string& run, const Timing& timing) {
  if (timing.built_kernels)
    print("{}: the time includes building kernels; --repeat 5 tells that of later runs\n", run);
}

void tell_end(const RunRecord& run) {
  const RegistrationResult& result = run.result;
  print("{}: {}{} after {} outer iterations; {} with {}\n", run.name, result.termination,
        result.reason.empty() ? "" : " (" + result.reason + ")", result.counts.outer_iterations,
        result.solver.name, result.solver.linear_solver);
  for (const auto& warning : result.warnings) print("{}: warning: {}\n", run.name, warning);
  tell_time(run.name, run.timing);
}

void tell_end(const EditRecord& run) {
  const EditResult& result = run.result;
  print("{}: {} after {} iterations; {} with {}\n", run.name, result.solver.termination,
        result.counts.solver_iterations, result.solver.name, result.solver.linear_solver);
  for (const auto& warning : result.warnings) print("{}: warning: {}\n", run.name, warning);
  tell_time(run.name, run.timing);
}

template <class Record>
void tell(const ExperimentPlan& plan, const std::vector<Record>& runs, const fs::path& folder) {
  print("{}\n", to_text(run_table(plan, runs)));
  for (const auto& run : runs) tell_end(run);
  print("Results are in {}\n", folder.string());
}

}  // namespace

ConfigSource config_source(const ExperimentOptions& options) {
  return {options.file, options.sets, data_folders(options.data), {experiments_folder()}};
}

void run_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  const ExperimentPlan plan = plan_experiment(config_source(options), registry);
  const fs::path folder = out_folder(options, plan);
  Workbench workbench(registry, show_line);
  ProgressLine line;
  if (plan.has_handles()) {
    const auto runs = edit_experiment(plan, folder, workbench, line.sink(), options.repeats);
    line.clear();
    tell(plan, runs, folder);
    return;
  }
  const auto runs = run_experiment(plan, folder, workbench, line.sink(), options.repeats);
  line.clear();
  tell(plan, runs, folder);
  check_ends(plan, runs);
}

void check_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  const ExperimentPlan plan = plan_experiment(config_source(options), registry);
  Workbench workbench(registry);
  check_experiment(plan, workbench);
  for (const auto& run : plan.runs)
    for (const auto& warning : workbench.pair(run.values).warnings)
      print("{}: warning: {}\n", run.name, warning);
  print("{}: good; it makes {} run{}:", options.file, plan.runs.size(), plan.runs.size() == 1 ? "" : "s");
  for (const auto& run : plan.runs) print(" {}", run.name);
  print("\n");
}

void compare_command(const ExperimentOptions& options) {
  const Registry registry = all_components();
  const ExperimentPlan plan = plan_experiment(config_source(options), registry);
  const fs::path folder = out_folder(options, plan);
  Workbench workbench(registry, show_line);
  ProgressLine line;
  const auto comparisons = compare_solvers(plan, folder, workbench, line.sink());
  line.clear();
  for (const auto& table : compare_tables(comparisons)) print("{}\n", to_text(table));
  print("Results are in {}\n", folder.string());
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
