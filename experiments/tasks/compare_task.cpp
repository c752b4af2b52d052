#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "experiments/tasks/task.h"
#include "framework/core/error.h"
#include "framework/problem/solver.h"
#include "framework/tracking/register_pair.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// What one solver made of the first problem of a run.
struct SolverTrial {
  std::string name;  ///< its label in the experiment
  SolverSummary summary;
  double initial_energy = 0;  ///< this and the next are Problem::energy, whatever the solver says
  double final_energy = 0;
  double relative_difference = 0;  ///< of the final energy to the lowest that any solver found
  double setup_ms = 0;             ///< medians of wall times: binding the solver to the problem,
  double solve_ms = 0;             ///< and solving it to the end
  int repetitions = 0;             ///< that the medians are of
};

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

std::unique_ptr<Problem> first_problem(const ExperimentRun& run, const Method& method, Workbench& workbench) {
  const FramePair& pair = workbench.pair(run.values);  // what is wrong with it names its own file
  Device& device = workbench.device(run.values);
  return told_with_place(run.place, [&] {
    const NamedHandles handles = make_handles(run, workbench.registry());
    if (!handles.empty()) return make_edit_problem(pair, handles, method, device);
    return freeze_problem(pair, method, device, static_cast<std::uint64_t>(run.values.integer("seed")));
  });
}

std::vector<SolverTrial> try_solvers(const ExperimentRun& run, const Bench& bench, const Registry& registry,
                                     const ProgressSink& progress) {
  std::vector<SolverTrial> trials;
  const auto& solvers = run.values.sections("solvers");
  for (const auto& entry : solvers) {
    const std::string& name = entry.first;
    const auto solver = registry.make<Solver>(entry.second);
    trials.push_back(
        told_with_place(run.place + ", solver " + name, [&] { return try_solver(name, *solver, bench); }));
    const SolverTrial& trial = trials.back();
    progress({"", static_cast<double>(trials.size()) / static_cast<double>(solvers.size()),
              fmt::format("{}: {:.1f} ms", name, trial.setup_ms + trial.solve_ms)});
  }
  compare_energies(trials);
  return trials;
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

ordered_json run_json(const std::string& name, const Problem& frozen,
                      const std::vector<SolverTrial>& trials) {
  ordered_json solvers = ordered_json::array();
  for (const auto& trial : trials) solvers.push_back(trial_json(trial));
  return {{"name", name},
          {"counts",
           {{"nodes", frozen.node_count()},
            {"constraints", count_constraints(frozen)},
            {"unknowns", frozen.unknown_count()}}},
          {"solvers", solvers}};
}

Table trials_table(const std::string& name, const Problem& frozen, const std::vector<SolverTrial>& trials) {
  Table table;
  table.title = fmt::format("{}: {} nodes, {} constraints, {} unknowns", name, frozen.node_count(),
                            count_constraints(frozen), frozen.unknown_count());
  table.header = {"solver",     "linear solver", "energy before", "energy after", "above lowest",
                  "iterations", "set-up ms",     "solve ms",      "total ms",     "ended"};
  for (const auto& trial : trials)
    table.rows.push_back(
        {{trial.name, trial.summary.linear_solver, fmt::format("{:.6g}", trial.initial_energy),
          fmt::format("{:.9g}", trial.final_energy), fmt::format("{:.1e}", trial.relative_difference),
          std::to_string(trial.summary.iterations), fmt::format("{:.2f}", trial.setup_ms),
          fmt::format("{:.2f}", trial.solve_ms), fmt::format("{:.2f}", trial.setup_ms + trial.solve_ms),
          trial.summary.termination}});
  return table;
}

class CompareTask : public Task {
 public:
  std::string result_file() const override { return "compare.json"; }
  std::string lead() const override { return "The same problem from the same start through every solver."; }
  bool is_reported() const override { return false; }
  ArtefactNames names() const override { return {}; }

  std::vector<std::string> check(const ExperimentRun& run, Workbench& workbench) const override {
    if (run.values.sections("solvers").empty())
      throw ConfigError(run.place +
                        ": there is nothing to compare; expected solvers under the key 'solvers'");
    return make_task(run.values)->check(run, workbench);
  }

  RunArtefacts make(const ExperimentRun& run, Workbench& workbench, const Making& making) const override {
    check(run, workbench);
    const Method method = make_method(run, workbench.registry());
    const auto frozen = first_problem(run, method, workbench);
    const Parameters& settings = run.values.section("compare");
    const Bench bench{*frozen, method.length_unit, workbench.device(run.values),
                      static_cast<int>(settings.integer("repetitions")), settings.real("max_seconds")};
    const auto trials = try_solvers(run, bench, workbench.registry(), making.progress);
    return {{run.name, run_json(run.name, *frozen, trials), trials_table(run.name, *frozen, trials), {}}};
  }
};

}  // namespace

std::unique_ptr<Task> make_compare_task() { return std::make_unique<CompareTask>(); }

ParameterTable compare_table() {
  return {
      integer("repetitions", 5).range(1, 1000).doc("solves that are timed, after one that is not"),
      real("max_seconds", 20).unit("s").above(0).doc("no further solve of a solver is begun after this time"),
  };
}

}  // namespace pliant
