#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "benchmarks/bench.h"
#include "benchmarks/peak.cl.embed.h"
#include "benchmarks/sheet.h"
#include "energies/energies.h"
#include "framework/problem/solver.h"
#include "framework/problem/structure.h"
#include "solvers/solvers.h"

namespace pliant::bench {
namespace {

/// Operations, and bytes that must move at least once, of a piece of work.
struct Work {
  double operations;
  double bytes;
};

struct Peak {
  double gflops;
  double gbytes;
};

/// The least time of several runs, by kernel, in milliseconds: what a run in peace takes.
StageTimes least_times(Device& device, int runs, const std::function<void()>& work) {
  work();
  device.measure_stages(true);
  device.take_kernel_times();
  StageTimes least;
  for (int run = 0; run < runs; ++run) {
    work();
    for (const auto& [kernel, time] : device.take_kernel_times()) {
      const auto [entry, fresh] = least.emplace(kernel, time);
      if (!fresh) entry->second = std::min(entry->second, time);
    }
  }
  device.measure_stages(false);
  return least;
}

Peak measure_peak(Device& device) {
  constexpr int turns = 20000, chunks = 32, length = 1 << 15;
  constexpr std::size_t stream = sizeof(float) * 16 * chunks * length;
  auto multiply_adds = device.kernel(embedded::benchmarks_peak_cl, "multiply_adds");
  auto add_streams = device.kernel(embedded::benchmarks_peak_cl, "add_streams");
  const auto out = device.allocate(sizeof(float) * 16 * chunks);
  const auto a = device.allocate(stream), b = device.allocate(stream), c = device.allocate(stream);
  for (const auto& buffer : {a, b, c}) device.fill_zero(buffer, stream);
  const auto times = least_times(device, 40, [&] {
    device.run("peak", multiply_adds, chunks, 1, turns, 0.5F, out);
    device.run("peak", add_streams, chunks, 1, length, a, b, c);
    device.finish();
  });
  return {2.0 * 16 * 16 * turns * chunks / times.at("multiply_adds") * 1e-6,
          3.0 * static_cast<double>(stream) / times.at("add_streams") * 1e-6};
}

/// One solver on one size of the sheet, and what its kernels have to do in one solve.
struct Subject {
  SheetSize size;
  std::string linear_solver;
  int iterations;
  std::map<std::string, Work> (*work)(const Problem& problem, const SolverSummary& summary);
};

/// The numbers that the work of the kernels depends on.
struct Counts {
  explicit Counts(const Problem& problem)
      : nodes(problem.node_count()), edges(static_cast<double>(problem.graph().edges.size())) {
    for (const auto& term : problem.terms()) {
      if (!term.constraints) continue;
      constraints = static_cast<double>(term.constraints->size());
      slots = term.constraints->influences.per_point;
      const Incidences incidences{term.constraints->influences.per_point,
                                  term.constraints->influences.nodes.host()};
      const auto lists = list_by_node(incidences, problem.node_count());
      blocks = static_cast<double>(find_blocks({&incidences}, {&lists}, problem.node_count()).columns.size());
    }
  }
  double nodes, edges;
  double constraints = 0, slots = 0, blocks = 0;
};

std::map<std::string, Work> structured_work(const Problem& problem, const SolverSummary& summary) {
  const Counts n(problem);
  const double entries = n.slots * n.constraints + 2 * n.edges;
  const double products = n.slots * n.slots * n.constraints + 4 * n.edges;
  const double multiply = 96 * n.blocks;  // M times three vectors
  const double node_vectors = 12 * 4 * n.nodes;
  const double steps = summary.iterations + 1, linear = summary.linear_iterations;
  return {
      {"lever_arms_of_constraints", {7 * n.slots * n.constraints, n.constraints * (12 + 24 * n.slots)}},
      {"lever_arms_regularization", {3 * n.edges, 40 * n.edges}},
      // Twice: at the start and at the end.
      {"evaluate_constraint",
       {2 * n.constraints * (24 * n.slots + 15), 2 * n.constraints * (44 + 20 * n.slots)}},
      {"evaluate_regularization", {2 * n.edges * (2 * 24 + 12), 2 * n.edges * (2 * 20 + 16)}},
      {"assemble", {32 * products + 28 * entries, 64 * n.blocks + 2 * products + 24 * entries}},
      // An iteration: M, two triangular solves and one product with the nodes' own blocks, vectors. A step:
      // the blocks' J^T J and factors, M once more.
      {"solve",
       {linear * (multiply + n.nodes * (2 * 144 + 2 * 144 + 12 * 10)) +
            steps * (multiply + n.nodes * (2 * 6 * 90 + 2 * 290 + 300)),
        linear * (64 * n.blocks + n.nodes * 2 * 312 + 10 * node_vectors) +
            steps * (64 * n.blocks + n.nodes * 3 * 312 + 10 * node_vectors)}},
  };
}

std::map<std::string, Work> dense_work(const Problem& problem, const SolverSummary& summary) {
  constexpr double block = 64;  // BLOCK in dense_cholesky.cl
  const Counts n(problem);
  const double steps = summary.iterations;
  const double unknowns = 12 * n.nodes;
  const double lower = (n.blocks + n.nodes) / 2;
  double panel = 0, update = 0;
  for (double rest = unknowns - block; rest > 0; rest -= block) {
    panel += 2 * rest * block * block;
    update += rest * rest * block;  // 2 per element of the lower triangle
  }
  const double pairs = n.slots * (n.slots + 1) / 2 * n.constraints;
  const double matrix = 4 * unknowns * unknowns;
  return {
      {"mm_constraints", {steps * pairs * (16 + 6 * 32), steps * (2 * 576 * lower + 36 * n.constraints)}},
      {"mm_edges", {steps * 3 * n.edges * 3 * 288, steps * (2 * 576 * lower + 300 * n.edges)}},
      {"clear_matrix", {0, steps * matrix}},
      {"scatter", {0, steps * 2 * 576 * lower}},
      {"diagonal", {steps * unknowns * block * block * 2 / 3, steps * unknowns * block * 12}},
      {"panel", {steps * panel, steps * matrix * 1.5}},
      {"update", {steps * update, steps * matrix * unknowns / block / 3}},
      {"eliminate_below", {steps * unknowns * unknowns, steps * matrix / 2}},
      {"eliminate_above", {steps * unknowns * unknowns, steps * matrix / 2}},
  };
}

std::map<std::string, Work> block_work(const Problem& problem, const SolverSummary& summary) {
  const Counts n(problem);
  const double steps = summary.iterations;
  return {
      {"expand", {0, steps * (1.5 * 576 * n.blocks)}},
      {"invert_diagonals", {steps * n.nodes * 2 * 12 * 144, steps * n.nodes * 2 * 576}},
      {"solve",
       {summary.linear_iterations * (288 * n.blocks + n.nodes * (288 + 12 * 10)),
        summary.linear_iterations * (576 * (n.blocks + n.nodes) + n.nodes * 10 * 48)}},
  };
}

nlohmann::ordered_json row_of(const Subject& subject, const std::string& kernel, double time,
                              const Work& work, const Peak& peak) {
  const double gflops = work.operations / time * 1e-6, gbytes = work.bytes / time * 1e-6;
  return {{"nodes", subject.size.nodes},
          {"constraints", subject.size.constraints},
          {"linear_solver", subject.linear_solver},
          {"kernel", kernel},
          {"time_ms", time},
          {"gflops", gflops},
          {"share_of_peak_gflops", gflops / peak.gflops},
          {"gbytes_per_s", gbytes},
          {"share_of_peak_gbytes", gbytes / peak.gbytes}};
}

void measure(const Subject& subject, const Registry& registry, Device& device, const Peak& peak,
             nlohmann::ordered_json& rows) {
  const auto problem = make_sheet(subject.size, registry, device);
  const auto solver = registry.make<Solver>(with_defaults(
      registry, "solver", "gauss_newton",
      {{"max_iterations", std::int64_t{subject.iterations}},
       {"linear_solver",
        Parameters::Sections{{"", with_defaults(registry, "linear_solver", subject.linear_solver)}}, true}}));
  SolverSummary summary;
  const auto times = least_times(device, 15, [&] {
    problem->reset_to_identity();
    const auto bound = solver->bind(*problem, device);
    bound->solve();
    summary = bound->summaries().front();
  });
  const auto work = subject.work(*problem, summary);
  for (const auto& [kernel, time] : times)
    if (const auto found = work.find(kernel); found != work.end())
      rows.push_back(row_of(subject, kernel, time, found->second, peak));
}

void print(const nlohmann::ordered_json& rows, const Peak& peak) {
  fmt::print("peak, measured in this run: {:.0f} GFLOP/s, {:.1f} GB/s\n\n", peak.gflops, peak.gbytes);
  fmt::print("{:>12} {:<15} {:<24} {:>9} {:>9} {:>8} {:>8} {:>8}\n", "nodes/constr.", "linear solver",
             "kernel", "ms", "GFLOP/s", "of peak", "GB/s", "of peak");
  for (const auto& row : rows)
    fmt::print("{:>12}  {:<15} {:<24} {:>9.3f} {:>9.1f} {:>7.0f}% {:>8.1f} {:>7.0f}%\n",
               fmt::format("{}/{}", row["nodes"].get<int>(), row["constraints"].get<int>()),
               row["linear_solver"].get<std::string>(), row["kernel"].get<std::string>(),
               row["time_ms"].get<double>(), row["gflops"].get<double>(),
               100 * row["share_of_peak_gflops"].get<double>(), row["gbytes_per_s"].get<double>(),
               100 * row["share_of_peak_gbytes"].get<double>());
}

}  // namespace

int run_kernels_mode(const Options& options) {
  Registry registry;
  register_energies(registry);
  register_solvers(registry);
  Device device;
  const Peak peak = measure_peak(device);
  std::vector<Subject> subjects{{{256, 2000, 1}, "structured", 30, structured_work},
                                {{256, 2000, 1}, "block_pcg", 1, block_work},
                                {{256, 2000, 1}, "dense_cholesky", 1, dense_work}};
  if (!options.quick) subjects.push_back({{4096, 30000, 1}, "structured", 30, structured_work});
  auto rows = nlohmann::ordered_json::array();
  for (const auto& subject : subjects)
    if (subject.linear_solver.find(options.only) != std::string::npos)
      measure(subject, registry, device, peak, rows);
  print(rows, peak);
  write_json(options, {{"peak_gflops", peak.gflops}, {"peak_gbytes_per_s", peak.gbytes}, {"kernels", rows}});
  return 0;
}

}  // namespace pliant::bench
