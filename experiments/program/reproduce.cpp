#include "experiments/program/reproduce.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include "experiments/program/commands.h"
#include "experiments/program/folders.h"
#include "experiments/program/progress_line.h"
#include "experiments/runner/compare.h"
#include "experiments/runner/components.h"
#include "experiments/runner/runner.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// An experiment to be reproduced.
struct Item {
  const char* name;    ///< of its file in the experiments folder
  bool is_comparison;  ///< of solvers, else it is run
  const char* needs;   ///< data that not every machine has; empty: none
};

constexpr std::array items{
    Item{"sheet", false, ""},
    Item{"edit_handles", false, ""},
    Item{"shirt", false, "deepdeform_seq258/depth_000000.png"},
    Item{"compare_solvers", true, ""},
};

class Reproduction {
 public:
  Reproduction(bool quick, fs::path out, std::string data)
      : quick_(quick), out_(std::move(out)), data_(std::move(data)), workbench_(registry_, show_line) {
    register_everything(registry_);
  }

  void make(const Item& item) {
    const auto folders = data_folders(data_);
    if (*item.needs != '\0' && !find_data(folders, item.needs)) {
      skip(item, folders);
      return;
    }
    ExperimentOptions options;
    options.file = (experiments_folder() / (std::string(item.name) + ".yaml")).string();
    options.data = data_;
    ExperimentPlan plan = plan_experiment(config_source(options), registry_);
    if (quick_) plan.keep_quick_runs();
    for (auto& table : item.is_comparison ? compare(item, plan) : run(item, plan)) {
      fmt::print("{}\n", to_text(table));
      tables_.push_back(std::move(table));
    }
  }

  /// The page over everything; gives its path.
  fs::path finish() const {
    const fs::path file = out_ / "index.html";
    const std::string page = make_overview_page(
        quick_ ? "Reproduction, quick form" : "Reproduction",
        "Distances in mm before and after; the first name of each row leads to its page.", tables_);
    write_file(file.string(), {page.begin(), page.end()});
    return fs::absolute(file).lexically_normal();
  }

 private:
  std::vector<Table> run(const Item& item, const ExperimentPlan& plan) {
    if (plan.has_handles())
      return {run_table(plan, edit_experiment(plan, out_ / item.name, workbench_), item.name)};
    ProgressLine line;
    const auto runs = run_experiment(plan, out_ / item.name, workbench_, line.sink());
    check_ends(plan, runs);
    return {run_table(plan, runs, item.name)};
  }

  std::vector<Table> compare(const Item& item, const ExperimentPlan& plan) {
    ProgressLine line;
    auto tables = compare_tables(compare_solvers(plan, out_ / item.name, workbench_, line.sink()));
    for (auto& table : tables) {
      for (auto& row : table.rows) row.link = std::string(item.name) + "/index.html";
    }
    return tables;
  }

  void skip(const Item& item, const std::vector<fs::path>& folders) {
    std::string looked;
    for (const auto& folder : folders)
      looked += (looked.empty() ? "" : ", ") + (folder / item.needs).lexically_normal().string();
    const std::string why = fmt::format("SKIPPED: its data was not found; looked for {}", looked);
    fmt::print("{}\n  {}\n  (give the folder with --data or the variable PLIANT_DATA)\n\n", item.name, why);
    tables_.push_back({item.name, {"skipped"}, {{{why}}}});
  }

  bool quick_;
  fs::path out_;
  std::string data_;
  Registry registry_;
  Workbench workbench_;
  std::vector<Table> tables_;
};

}  // namespace

void reproduce_command(bool quick, const std::string& out, const std::string& data) {
  Reproduction reproduction(quick, out.empty() ? fs::path("out/reproduce") : fs::path(out), data);
  for (const auto& item : items) reproduction.make(item);
  fmt::print("The report is {}\n", reproduction.finish().string());
}

}  // namespace pliant
