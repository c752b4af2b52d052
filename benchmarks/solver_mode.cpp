#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "benchmarks/bench.h"
#include "benchmarks/sheet.h"
#include "energies/energies.h"
#include "framework/problem/solver.h"
#include "solvers/solvers.h"

namespace pliant::bench {
namespace {

constexpr double accuracy = 1e-5;  // of the energy, relative to Ceres' converged one

struct Contender {
  std::string solver;
  std::string linear_solver;
};

/// One solver on one problem: what there is to time, and where it ends.
struct Entry {
  SheetSize size;
  Contender contender;
  std::string name;
  double energy = 0;
  double gap = 0;    ///< relative to the reference
  std::string note;  ///< why it was left out, if it was
};

/// All that is measured on one problem.
class Case {
 public:
  Case(const SheetSize& size, const Registry& registry, Device& device)
      : size_(size), registry_(registry), device_(device), problem_(make_sheet(size, registry, device)) {
    reference_ = solve({"ceres_lm", "cgnr"}, 1e-12);
  }

  const SheetSize& size() const { return size_; }
  double reference() const { return reference_; }

  /// Binds, solves and waits, from the identity; everything but the building of programs, which a first
  /// call does.
  void run(const Solver& solver) {
    problem_->reset_to_identity();
    const auto bound = solver.bind(*problem_, device_);
    bound->solve();
    bound->summaries();
  }

  std::unique_ptr<Solver> make(const Contender& contender, double tolerance) const {
    const Parameters::Value tolerance_value{"tolerance", tolerance};
    const Parameters::Value iterations{"max_iterations", std::int64_t{100}};
    Parameters::Value linear{"linear_solver", contender.linear_solver};
    if (contender.solver == "gauss_newton")
      linear = {
          "linear_solver",
          Parameters::Sections{{"", with_defaults(registry_, "linear_solver", contender.linear_solver)}},
          true};
    return registry_.make<Solver>(
        with_defaults(registry_, "solver", contender.solver, {tolerance_value, iterations, linear}));
  }

  /// Energy in double after a solve.
  double solve(const Contender& contender, double tolerance) {
    run(*make(contender, tolerance));
    return problem_->energy();
  }

 private:
  SheetSize size_;
  const Registry& registry_;
  Device& device_;
  std::unique_ptr<Problem> problem_;
  double reference_ = 0;
};

std::vector<SheetSize> sizes(bool quick) {
  if (quick) return {{64, 1000, 1}, {256, 2000, 1}, {256, 2000, 1000}};
  return {{64, 1000, 1},    {256, 2000, 1},   {256, 8000, 1},    {1024, 8000, 1},
          {4096, 30000, 1}, {64, 1000, 1000}, {256, 2000, 1000}, {1024, 8000, 1000}};
}

/// Why a contender stays out, if it does.
std::optional<std::string> left_out(const Contender& contender, const SheetSize& size) {
  if (contender.linear_solver == "dense_normal_cholesky" && size.nodes > 64) return "dense: 64 nodes only";
  if (contender.linear_solver == "dense_cholesky" && size.nodes > 256) return "dense: up to 256 nodes";
  if (contender.linear_solver == "sparse_normal_cholesky" && size.nodes > 1024)
    return "takes over a minute a solve";
  return std::nullopt;
}

std::vector<Contender> contenders(const Registry& registry) {
  std::vector<Contender> all{
      {"ceres_lm", "sparse_normal_cholesky"}, {"ceres_lm", "cgnr"}, {"ceres_lm", "dense_normal_cholesky"}};
  for (const auto* info : registry.components("linear_solver")) all.push_back({"gauss_newton", info->name});
  return all;
}

std::string case_name(const SheetSize& size) {
  return fmt::format("{}/{}{}", size.nodes, size.constraints, size.length_unit == 1000 ? " m" : "");
}

nlohmann::ordered_json row_of(const Entry& entry, const std::map<std::string, double>& times) {
  const auto ratio_to = [&](const char* linear_solver) -> nlohmann::ordered_json {
    const auto other = times.find(case_name(entry.size) + " ceres_lm " + linear_solver);
    const auto own = times.find(entry.name);
    if (other == times.end() || own == times.end()) return nullptr;
    return own->second / other->second;
  };
  nlohmann::ordered_json row{{"nodes", entry.size.nodes},
                             {"constraints", entry.size.constraints},
                             {"length_unit_mm", entry.size.length_unit},
                             {"solver", entry.contender.solver},
                             {"linear_solver", entry.contender.linear_solver}};
  if (!entry.note.empty()) {
    row["left_out"] = entry.note;
    return row;
  }
  row["time_ms"] = times.at(entry.name);
  row["energy"] = entry.energy;
  row["energy_above_minimum"] = entry.gap;
  row["ratio_to_ceres_sparse"] = ratio_to("sparse_normal_cholesky");
  row["ratio_to_ceres_cgnr"] = ratio_to("cgnr");
  return row;
}

void print(const nlohmann::ordered_json& rows) {
  fmt::print("{:>16} {:<36} {:>10} {:>10} {:>10} {:>10}\n", "nodes/constr.", "solver", "ms", "1/sparse",
             "1/cgnr", "gap");
  for (const auto& row : rows) {
    const auto label = fmt::format("{}/{}{}", row["nodes"].get<int>(), row["constraints"].get<int>(),
                                   row["length_unit_mm"] == 1000 ? " m" : "");
    const auto solver = row["solver"].get<std::string>() + " " + row["linear_solver"].get<std::string>();
    if (row.contains("left_out")) {
      fmt::print("{:>16} {:<36} left out: {}\n", label, solver, row["left_out"].get<std::string>());
      continue;
    }
    const auto inverse = [&](const char* key) {
      return row[key].is_null() ? std::string("-") : fmt::format("{:.1f}", 1 / row[key].get<double>());
    };
    const double gap = row["energy_above_minimum"];
    fmt::print("{:>16} {:<36} {:>10.3f} {:>10} {:>10} {:>10.1e}{}\n", label, solver,
               row["time_ms"].get<double>(), inverse("ratio_to_ceres_sparse"), inverse("ratio_to_ceres_cgnr"),
               gap, gap > accuracy ? "  MISSES THE MINIMUM" : "");
  }
}

}  // namespace

int run_solver_mode(const Options& options) {
  Registry registry;
  register_energies(registry);
  register_solvers(registry);
  Device device;
  Timings timings;
  std::vector<std::unique_ptr<Case>> cases;
  std::vector<std::unique_ptr<Solver>> solvers;
  std::vector<Entry> entries;
  for (const auto& size : sizes(options.quick)) {
    auto& made = *cases.emplace_back(std::make_unique<Case>(size, registry, device));
    for (const auto& contender : contenders(registry)) {
      Entry entry{.size = size,
                  .contender = contender,
                  .name = case_name(size) + " " + contender.solver + " " + contender.linear_solver,
                  .note = ""};
      if (entry.name.find(options.only) == std::string::npos) continue;
      if (const auto reason = left_out(contender, size)) {
        entry.note = *reason;
        entries.push_back(entry);
        continue;
      }
      const auto& solver = *solvers.emplace_back(made.make(contender, 1e-6));
      entry.energy = made.solve(contender, 1e-6);
      entry.gap = entry.energy / made.reference() - 1;
      const bool is_ceres = contender.solver == "ceres_lm";
      timings.add(entry.name, {options.quick || is_ceres ? 3 : 9, is_ceres ? 1 : 0},
                  [&made, &solver] { made.run(solver); });
      entries.push_back(entry);
    }
  }
  const auto times = timings.run();
  auto rows = nlohmann::ordered_json::array();
  for (const auto& entry : entries) rows.push_back(row_of(entry, times));
  print(rows);
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
