#include "experiments/program/reproduce.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/program/commands.h"
#include "experiments/program/folders.h"
#include "experiments/program/output.h"
#include "experiments/program/progress_line.h"
#include "experiments/program/time_left.h"
#include "experiments/report/study_page.h"
#include "experiments/runner/components.h"
#include "experiments/runner/overview.h"
#include "experiments/runner/runner.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr const char* page_name = "index.html";

/// An experiment to be reproduced.
struct Item {
  std::string name;            ///< of its folder in the result
  fs::path file;               ///< in the experiments folder
  std::string title = {};      ///< of its part of the page; empty: what its `study` says
  bool is_comparison = false;  ///< of solvers, else it is run
  std::string needs = {};      ///< data that not every machine has; empty: none
};

const std::vector<Item>& first_items() {
  static const std::vector<Item> items{
      {"sheet", "sheet.yaml", "A sheet that bends"},
      {"edit_handles", "edit_handles.yaml", "A sheet bent by handles"},
      {"shirt", "shirt.yaml", "A shirt [DeepDeform]", false, "deepdeform_seq258/depth_000000.png"},
      {"compare_solvers", "compare_solvers.yaml", "The device's solvers beside Ceres", true},
  };
  return items;
}

/// A chapter of the thesis whose experiments are files of a folder.
struct Chapter {
  const char* folder;
  const char* title;
};

constexpr std::array chapters{Chapter{"chapter5", "Chapter 5: registration of pairs"},
                              Chapter{"chapter6", "Chapter 6: tracking what deforms"}};

/// The experiments of a chapter, in the order of their files' names.
std::vector<Item> items_of(const Chapter& chapter) {
  std::vector<Item> items;
  for (const auto& entry : fs::directory_iterator(experiments_folder() / chapter.folder))
    if (entry.path().extension() == ".yaml")
      items.push_back({entry.path().stem().string(), fs::path(chapter.folder) / entry.path().filename()});
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.name < b.name; });
  return items;
}

/// What one call reproduces.
struct Selection {
  std::string title;
  std::vector<Item> items;
};

Selection selection_of(const std::string& chapter) {
  if (chapter.empty()) {
    Selection all{"Reproduction", first_items()};
    for (const Chapter& each : chapters)
      for (Item& item : items_of(each)) all.items.push_back(std::move(item));
    return all;
  }
  std::vector<std::string> names;
  for (const Chapter& each : chapters) {
    if (chapter == each.folder) return {each.title, items_of(each)};
    names.emplace_back(each.folder);
  }
  throw ConfigError(fmt::format("unknown chapter '{}'; expected {}{}", chapter, fmt::join(names, ", "),
                                suggestion(chapter, names)));
}

class Reproduction {
 public:
  explicit Reproduction(const ReproduceOptions& options)
      : options_(options), selection_(selection_of(options.chapter)), workbench_(registry_, show_line) {
    register_everything(registry_);
    for (const Item& item : selection_.items) plan(item);
  }

  /// Gives the path of the page over everything.
  fs::path make(const fs::path& out) {
    ResultFolder result(out, files_, inputs_, ResultFolder::Leftovers::stay);
    result.keep_only(begun_in(result.unfinished()));
    std::size_t runs = 0;
    for (const auto& planned : planned_) runs += planned.plan ? planned.plan->runs.size() : 0;
    TimeLeft time(runs);
    for (const auto& planned : planned_) {
      studies_.push_back(planned.plan ? study(planned, result, time) : skipped(planned.item));
      for (const Table& table : studies_.back().tables) print("{}\n", to_text(table));
    }
    if (!has_made_ && failure_) std::rethrow_exception(failure_);
    write_page(result.unfinished());
    result.commit();
    return fs::absolute(out / page_name).lexically_normal();
  }

  /// Throws the error of the first run that failed, if one did.
  void check_ends() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  struct Planned {
    const Item& item;
    std::unique_ptr<Task> task;
    std::optional<ExperimentPlan> plan;  ///< none: its data was not found
  };

  /// The folders of experiments that an earlier call has finished, or begun.
  ResultFolder::Files begun_in(const fs::path& folder) const {
    ResultFolder::Files begun;
    for (const fs::path& name : folders_)
      if (fs::exists(folder / name)) begun.push_back(name);
    return begun;
  }

  void plan(const Item& item) {
    if (!item.needs.empty() && !find_data(data_folders(options_.data), item.needs)) {
      planned_.push_back({item, {}, {}});
      return;
    }
    ExperimentOptions options;
    options.file = (experiments_folder() / item.file).string();
    options.data = options_.data;
    ExperimentPlan plan = plan_experiment(config_source(options), registry_);
    if (options_.quick) plan.keep_quick_runs();
    auto task = item.is_comparison ? make_compare_task() : make_task(plan.experiment.values);
    for (const auto& file : result_files(*task, plan, registry_)) files_.push_back(item.name / file);
    inputs_.insert(inputs_.end(), plan.experiment.files.begin(), plan.experiment.files.end());
    folders_.emplace_back(item.name);
    planned_.push_back({item, std::move(task), std::move(plan)});
  }

  /// Makes an experiment; what of it fails is told in its study.
  Study study(const Planned& planned, ResultFolder& result, TimeLeft& time) {
    const fs::path folder = result.unfinished() / planned.item.name;
    ProgressLine line;
    const ProgressSink sink = line.sink();
    const ExperimentResult made = run_experiment(*planned.task, *planned.plan, folder, workbench_,
                                                 time.counting(sink), {.repeats = 0, .is_one_of_many = true});
    line.clear();
    note_failure(made);
    if (made.runs.empty()) return failed(planned.item, made);
    result.keep();
    has_made_ = true;
    return study_of(planned, made, folder);
  }

  static Study failed(const Item& item, const ExperimentResult& made) {
    std::vector<std::string> notes;
    for (const auto& run : made.failed) notes.push_back(fmt::format("{} failed: {}", run.name, run.message));
    return note_of(item, notes);
  }

  static Study note_of(const Item& item, std::vector<std::string> notes) {
    Study study;
    study.name = item.name;
    study.title = item.title.empty() ? item.name : item.title;
    study.notes = std::move(notes);
    return study;
  }

  Study study_of(const Planned& planned, const ExperimentResult& made, const fs::path& folder) {
    const DeviceInfo& device = workbench_.device(planned.plan->runs.front().values).info();
    Study study = pliant::study_of(*planned.plan, made, device, folder);
    study.name = planned.item.name;
    if (!planned.item.title.empty()) study.title = planned.item.title;
    if (study.tables.empty() && study.charts.empty())
      study.tables = run_tables(*planned.task, *planned.plan, made, planned.item.name);
    return study;
  }

  void note_failure(const ExperimentResult& made) {
    try {
      pliant::check_ends(made);
    } catch (const Error&) {
      if (!failure_) failure_ = std::current_exception();
    }
  }

  Study skipped(const Item& item) const {
    std::string looked;
    for (const auto& folder : data_folders(options_.data))
      looked += (looked.empty() ? "" : ", ") + (folder / item.needs).lexically_normal().string();
    const std::string why = fmt::format("SKIPPED: its data was not found; looked for {}", looked);
    print("{}\n  {}\n  (give the folder with --data or the variable PLIANT_DATA)\n\n", item.name, why);
    return note_of(item, {why});
  }

  void write_page(const fs::path& folder) const {
    const std::string page = make_study_page(
        selection_.title + (options_.quick ? ", quick form" : ""),
        "Experiments of A. C. dos Santos Souza, An Adaptive Approach to Real-Time 3D Non-Rigid "
        "Registration (UFBA, 2014), on data whose true motion is known.",
        studies_);
    write_file((folder / page_name).string(), {page.begin(), page.end()});
  }

  const ReproduceOptions& options_;
  Selection selection_;
  Registry registry_;
  Workbench workbench_;
  std::vector<Planned> planned_;
  ResultFolder::Files files_{page_name};
  ResultFolder::Files inputs_;
  ResultFolder::Files folders_;
  std::vector<Study> studies_;
  std::exception_ptr failure_;  // of the first run that failed
  bool has_made_ = false;       // any run
};

}  // namespace

void reproduce_command(const ReproduceOptions& options) {
  Reproduction reproduction(options);
  const fs::path out = !options.out.empty()      ? fs::path(options.out)
                       : options.chapter.empty() ? fs::path("out/reproduce")
                                                 : fs::path("out") / options.chapter;
  print("The report is {}\n", reproduction.make(out).string());
  reproduction.check_ends();
}

}  // namespace pliant
