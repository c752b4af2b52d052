#include "experiments/runner/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "experiments/runner/result_json.h"
#include "experiments/runner/runner.h"
#include "framework/core/error.h"
#include "framework/io/file.h"
#include "framework/tracking/register_pair.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// A problem of a run that solvers are tried on, and how long to try.
struct Bench {
  const Problem& frozen;
  double length_unit;
  Device& device;
  int repetitions;
  double max_seconds;
};

/// One solve of a fresh problem that is identical to the frozen one.
SolverTrial solve_once(const Solver& solver, const Bench& bench) {
  SolverTrial trial;
  Problem problem(bench.frozen.graph(), bench.frozen.terms(), bench.length_unit, bench.frozen.transform());
  problem.unknowns() = Array<float>(bench.frozen.unknowns().host());
  trial.initial_energy = problem.energy();
  const auto start = Clock::now();
  const auto bound = solver.bind(problem, bench.device);
  bench.device.finish();
  trial.setup_ms = milliseconds_since(start);
  const auto bound_at = Clock::now();
  bound->solve();
  bench.device.finish();
  trial.solve_ms = milliseconds_since(bound_at);
  trial.summary = bound->summaries().front();
  if (trial.summary.termination == "failed") throw NumericalError(trial.summary.failure);
  trial.final_energy = problem.energy();
  return trial;
}

/// The first solve is not timed (kernels are built in it), unless it alone took all the time there is.
SolverTrial try_solver(const std::string& name, const Solver& solver, const Bench& bench) {
  const auto start = Clock::now();
  SolverTrial trial = solve_once(solver, bench);
  std::vector<double> setups;
  std::vector<double> solves;
  while (static_cast<int>(solves.size()) < bench.repetitions &&
         milliseconds_since(start) < 1e3 * bench.max_seconds) {
    const SolverTrial again = solve_once(solver, bench);
    setups.push_back(again.setup_ms);
    solves.push_back(again.solve_ms);
  }
  trial.name = name;
  trial.repetitions = std::max(1, static_cast<int>(solves.size()));
  if (solves.empty()) return trial;
  trial.setup_ms = median(setups);
  trial.solve_ms = median(solves);
  return trial;
}

int count_constraints(const Problem& problem) {
  for (const auto& term : problem.terms()) {
    if (term.constraints != nullptr) return static_cast<int>(term.constraints->size());
  }
  return 0;
}

void compare_energies(std::vector<SolverTrial>& trials) {
  const auto lowest = std::min_element(trials.begin(), trials.end(), [](const auto& a, const auto& b) {
                        return a.final_energy < b.final_energy;
                      })->final_energy;
  for (auto& trial : trials)
    trial.relative_difference = lowest > 0 ? (trial.final_energy - lowest) / lowest : 0;
}

std::unique_ptr<Problem> first_problem(const ExperimentPlan::Run& run, const Method& method,
                                       Workbench& workbench) {
  const FramePair& pair = workbench.pair(run.values);  // what is wrong with it names its own file
  Device& device = workbench.device(run.values);
  return told_with_place(run.place, [&] {
    const NamedHandles handles = make_handles(run, workbench.registry());
    if (!handles.empty()) return make_edit_problem(pair, handles, method, device);
    return freeze_problem(pair, method, device, static_cast<std::uint64_t>(run.values.integer("seed")));
  });
}

RunComparison compare_run(const ExperimentPlan::Run& run, Workbench& workbench,
                          const ProgressSink& progress) {
  const Method method = make_method(run, workbench.registry());
  const auto frozen = first_problem(run, method, workbench);
  RunComparison comparison{
      run.name, frozen->node_count(), count_constraints(*frozen), frozen->unknown_count(), {}};
  const Parameters& settings = run.values.section("compare");
  const Bench bench{*frozen, method.length_unit, workbench.device(run.values),
                    static_cast<int>(settings.integer("repetitions")), settings.real("max_seconds")};
  const auto& solvers = run.values.sections("solvers");
  for (std::size_t i = 0; i < solvers.size(); ++i) {
    const std::string& name = solvers[i].first;
    const auto solver = workbench.registry().make<Solver>(solvers[i].second);
    comparison.trials.push_back(
        told_with_place(run.place + ", solver " + name, [&] { return try_solver(name, *solver, bench); }));
    const SolverTrial& trial = comparison.trials.back();
    if (progress)
      progress({run.name, static_cast<double>(i + 1) / static_cast<double>(solvers.size()),
                fmt::format("{}: {:.1f} ms", trial.name, trial.setup_ms + trial.solve_ms)});
  }
  compare_energies(comparison.trials);
  return comparison;
}

ordered_json trial_json(const SolverTrial& trial) {
  return {{"name", trial.name},
          {"solver", trial.summary.solver},
          {"linear_solver", trial.summary.linear_solver},
          {"termination", trial.summary.termination},
          {"iterations", trial.summary.iterations},
          {"energy",
           {{"initial", trial.initial_energy},
            {"final", trial.final_energy},
            {"relative_difference", trial.relative_difference}}},
          {"time_ms",
           {{"total", trial.setup_ms + trial.solve_ms},
            {"setup", trial.setup_ms},
            {"solve", trial.solve_ms},
            {"repetitions", trial.repetitions}}}};
}

ordered_json comparison_json(const RunComparison& comparison) {
  ordered_json trials = ordered_json::array();
  for (const auto& trial : comparison.trials) trials.push_back(trial_json(trial));
  return {{"name", comparison.name},
          {"counts",
           {{"nodes", comparison.nodes},
            {"constraints", comparison.constraints},
            {"unknowns", comparison.unknowns}}},
          {"solvers", trials}};
}

void write_results(const ExperimentPlan& plan, const std::filesystem::path& folder, const DeviceInfo& device,
                   const std::vector<RunComparison>& comparisons) {
  ordered_json runs = ordered_json::array();
  for (const auto& comparison : comparisons) runs.push_back(comparison_json(comparison));
  write_json((folder / "compare.json").string(), {{"schema", 1},
                                                  {"experiment", plan.experiment.to_json()},
                                                  {"environment", environment_json(device, plan)},
                                                  {"runs", runs}});
  const std::string page = make_overview_page(
      plan.name, "The same problem from the same start through every solver.", compare_tables(comparisons));
  write_file((folder / "index.html").string(), {page.begin(), page.end()});
}

}  // namespace

ResultFolder::Files compare_files() { return {"experiment.yaml", "compare.json", "index.html"}; }

std::vector<RunComparison> compare_solvers(const ExperimentPlan& plan, const std::filesystem::path& folder,
                                           Workbench& workbench, const ProgressSink& progress) {
  if (plan.experiment.values.sections("solvers").empty())
    throw ConfigError(plan.name + ": there is nothing to compare; expected solvers under the key 'solvers'");
  ResultFolder result(folder, compare_files(), plan.experiment.files);
  write_experiment(result.unfinished(), plan);
  std::vector<RunComparison> comparisons;
  for (const auto& run : plan.runs) comparisons.push_back(compare_run(run, workbench, progress));
  write_results(plan, result.unfinished(), workbench.device(plan.experiment.values).info(), comparisons);
  result.commit();
  return comparisons;
}

std::vector<Table> compare_tables(const std::vector<RunComparison>& comparisons) {
  std::vector<Table> tables;
  for (const auto& comparison : comparisons) {
    Table table;
    table.title = fmt::format("{}: {} nodes, {} constraints, {} unknowns", comparison.name, comparison.nodes,
                              comparison.constraints, comparison.unknowns);
    table.header = {"solver",     "linear solver", "energy before", "energy after", "above lowest",
                    "iterations", "set-up ms",     "solve ms",      "total ms",     "ended"};
    for (const auto& trial : comparison.trials)
      table.rows.push_back(
          {{trial.name, trial.summary.linear_solver, fmt::format("{:.6g}", trial.initial_energy),
            fmt::format("{:.9g}", trial.final_energy), fmt::format("{:.1e}", trial.relative_difference),
            std::to_string(trial.summary.iterations), fmt::format("{:.2f}", trial.setup_ms),
            fmt::format("{:.2f}", trial.solve_ms), fmt::format("{:.2f}", trial.setup_ms + trial.solve_ms),
            trial.summary.termination}});
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace pliant
