#include "experiments/program/reproduce.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/program/commands.h"
#include "experiments/program/folders.h"
#include "experiments/program/output.h"
#include "experiments/program/progress_line.h"
#include "experiments/runner/components.h"
#include "experiments/runner/runner.h"
#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr const char* page_name = "index.html";

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

  /// Makes all; gives the path of the page over everything.
  fs::path make() {
    for (const auto& item : items) plan(item);
    ResultFolder result(out_, files_, inputs_);
    try {
      make_all(result.unfinished());
    } catch (const Error& error) {
      if (tables_.empty()) throw;
      result.keep();
      throw Error(fmt::format("{}; the experiments before it are kept in {}", error.what(),
                              result.unfinished().string()),
                  error.exit_code());
    }
    result.commit();
    return fs::absolute(out_ / page_name).lexically_normal();
  }

 private:
  struct Planned {
    const Item& item;
    std::unique_ptr<Task> task;
    std::optional<ExperimentPlan> plan;  ///< none: its data was not found
  };

  void plan(const Item& item) {
    if (*item.needs != '\0' && !find_data(data_folders(data_), item.needs)) {
      planned_.push_back({item, {}, {}});
      return;
    }
    ExperimentOptions options;
    options.file = (experiments_folder() / (std::string(item.name) + ".yaml")).string();
    options.data = data_;
    ExperimentPlan plan = plan_experiment(config_source(options), registry_);
    if (quick_) plan.keep_quick_runs();
    auto task = item.is_comparison ? make_compare_task() : make_task(plan.experiment.values);
    for (const auto& file : result_files(*task, plan, registry_)) files_.push_back(item.name / file);
    inputs_.insert(inputs_.end(), plan.experiment.files.begin(), plan.experiment.files.end());
    planned_.push_back({item, std::move(task), std::move(plan)});
  }

  void make_all(const fs::path& folder) {
    for (const auto& [item, task, plan] : planned_) {
      if (!plan) {
        skip(item);
        continue;
      }
      for (auto& table : run(item.name, *task, *plan, folder)) {
        print("{}\n", to_text(table));
        tables_.push_back(std::move(table));
      }
    }
    const std::string page = make_overview_page(
        quick_ ? "Reproduction, quick form" : "Reproduction",
        "Distances in mm before and after; the first name of each row leads to its page.", tables_);
    write_file((folder / page_name).string(), {page.begin(), page.end()});
  }

  std::vector<Table> run(const char* name, const Task& task, const ExperimentPlan& plan,
                         const fs::path& folder) {
    ProgressLine line;
    const auto result = run_experiment(task, plan, folder / name, workbench_, line.sink());
    check_ends(result);
    return run_tables(task, plan, result, name);
  }

  void skip(const Item& item) {
    std::string looked;
    for (const auto& folder : data_folders(data_))
      looked += (looked.empty() ? "" : ", ") + (folder / item.needs).lexically_normal().string();
    const std::string why = fmt::format("SKIPPED: its data was not found; looked for {}", looked);
    print("{}\n  {}\n  (give the folder with --data or the variable PLIANT_DATA)\n\n", item.name, why);
    tables_.push_back({item.name, {"skipped"}, {{{why}}}});
  }

  bool quick_;
  fs::path out_;
  std::string data_;
  Registry registry_;
  Workbench workbench_;
  std::vector<Planned> planned_;
  ResultFolder::Files files_{page_name};
  ResultFolder::Files inputs_;
  std::vector<Table> tables_;
};

}  // namespace

void reproduce_command(bool quick, const std::string& out, const std::string& data) {
  Reproduction reproduction(quick, out.empty() ? fs::path("out/reproduce") : fs::path(out), data);
  print("The report is {}\n", reproduction.make().string());
}

}  // namespace pliant
