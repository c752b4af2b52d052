#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "benchmarks/bench.h"
#include "experiments/program/folders.h"
#include "experiments/runner/components.h"
#include "experiments/runner/experiment.h"
#include "experiments/tasks/workbench.h"
#include "framework/core/stopwatch.h"
#include "framework/evaluation/metrics.h"
#include "framework/tracking/register_pair.h"

namespace pliant::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct DataSet {
  const char* name;
  const char* file;   ///< the experiment that describes it, in the experiments folder
  const char* needs;  ///< data that not every machine has; empty: none
};

constexpr std::array data_sets{
    DataSet{"sheet", "sheet.yaml", ""},
    DataSet{"cheeks", "faces/cheeks.yaml", "ict_face/ict_face.glb"},
    DataSet{"smile", "faces/smile.yaml", "ict_face/ict_face.glb"},
    DataSet{"jaw", "faces/jaw.yaml", "ict_face/ict_face.glb"},
    DataSet{"shirt", "shirt.yaml", "deepdeform_seq258/depth_000000.png"},
};
constexpr std::array methods{"ed", "ad_nodes", "ad_nodes_ad_cons", "best", "best_depth"};

/// Makes the experiment that a file would be if it extended another method than it does.
class MethodSwap {
 public:
  MethodSwap(const Registry& registry, std::vector<fs::path> data)
      : registry_(registry), data_(std::move(data)) {}

  Parameters make(const fs::path& file, const fs::path& method) const {
    const YAML::Node given = YAML::LoadFile(file.string());
    const Parameters own = load(file, {});
    const Parameters bare = load(method, {as_set(given, "data")});
    std::vector<std::string> sets;
    for (const auto& entry : given) {
      const auto key = entry.first.as<std::string>();
      if (key == "extends" || key == "runs" || key == "quick") continue;
      const YAML::Node value = what_concerns(bare, own, key, entry.second);
      if (value.size() > 0 || !value.IsMap()) sets.push_back(key + "=" + YAML::Dump(value));
    }
    return load(method, sets);
  }

 private:
  /// What a value says of components that the method `bare` has: neither the spacing of a uniform graph where
  /// that has a quadtree, nor the scale of an energy that it does without.
  static YAML::Node what_concerns(const Parameters& bare, const Parameters& own, const std::string& key,
                                  const YAML::Node& value) {
    const auto table = experiment_table();
    const auto type = table.find(key)->type();
    if (type == ParameterType::component && value.IsMap() && !value["type"] &&
        own.section(key).component() != bare.section(key).component())
      return YAML::Node(YAML::NodeType::Map);
    if (type != ParameterType::components) return value;
    YAML::Node kept(YAML::NodeType::Map);
    for (const auto& [label, section] : bare.sections(key))
      if (value[label]) kept[label] = value[label];
    return kept;
  }

  static std::string as_set(const YAML::Node& given, const std::string& key) {
    return key + "=" + YAML::Dump(given[key]);
  }

  Parameters load(const fs::path& file, std::vector<std::string> sets) const {
    return plan_experiment({file, std::move(sets), data_, {experiments_folder()}}, registry_)
        .experiment.values;
  }

  const Registry& registry_;
  std::vector<fs::path> data_;
};

struct Repetition {
  double total_ms;
  StageTimes stages;
};

DeviceCounts difference(const DeviceCounts& after, const DeviceCounts& before) {
  return {after.allocations - before.allocations, after.uploads - before.uploads,
          after.uploaded_bytes - before.uploaded_bytes, after.reads - before.reads,
          after.read_bytes - before.read_bytes};
}

/// One data set with one method.
class Subject {
 public:
  Subject(const DataSet& data, const std::string& method, const Parameters& experiment, Workbench& workbench)
      : name(fmt::format("{} {}", data.name, method)),
        data_(data.name),
        method_name_(method),
        pair_(workbench.pair(experiment)),
        truth_(workbench.truth(experiment)),
        method_(make_method(experiment, workbench.registry())),
        device_(workbench.device(experiment)),
        seed_(static_cast<std::uint64_t>(experiment.integer("seed"))) {
    device_.measure_stages(true);
  }

  /// The registration that is not timed: it builds the kernels, and tells what comes out.
  void warm_up() {
    const Stopwatch watch;
    const RegistrationResult result = register_pair(pair_, method_, device_, seed_);
    const Evaluation evaluation(pair_, truth_, result.source, make_surface_image(pair_.target, pair_.camera));
    initial_ = evaluation.measure(result.source.points);
    metrics_ = evaluation.measure(result.points);
    counts_ = result.counts;
    warm_up_ms_ = watch.milliseconds();
  }

  /// A pair that takes many seconds is timed once: its median would be no surer, and the wait long.
  int repetitions(int most) const { return std::clamp(static_cast<int>(5000 / warm_up_ms_), 1, most); }

  void repeat() {
    const DeviceCounts before = device_.counts();
    RegistrationResult result = register_pair(pair_, method_, device_, seed_);
    traffic_ = difference(device_.counts(), before);
    repetitions_.push_back({result.total_ms, std::move(result.time_ms)});
  }

  ordered_json row(double time_ms) {
    const auto epe = [](const Metrics& metrics) -> ordered_json {
      if (!metrics.truth) return nullptr;
      return metrics.truth->epe_mean;
    };
    return {{"name", method_name_},
            {"data", data_},
            {"time_ms", time_ms},
            {"fps", 1000 / time_ms},
            {"stages_ms", stages_of_median()},
            {"nodes", counts_.nodes},
            {"constraints", counts_.constraints},
            {"uploads", traffic_.uploads},
            {"uploaded_bytes", traffic_.uploaded_bytes},
            {"reads", traffic_.reads},
            {"read_bytes", traffic_.read_bytes},
            {"allocations", traffic_.allocations},
            {"outer_iterations", counts_.outer_iterations},
            {"residual_mean", metrics_.residual_mean},
            {"epe_mean", epe(metrics_)},
            {"epe_initial_mean", epe(initial_)}};
  }

  const std::string name;

 private:
  const StageTimes& stages_of_median() {
    const auto middle = repetitions_.begin() + static_cast<std::ptrdiff_t>(repetitions_.size() / 2);
    std::nth_element(repetitions_.begin(), middle, repetitions_.end(),
                     [](const auto& a, const auto& b) { return a.total_ms < b.total_ms; });
    return middle->stages;
  }

  std::string data_, method_name_;
  const FramePair& pair_;
  const std::optional<PairTruth>& truth_;
  Method method_;
  Device& device_;
  std::uint64_t seed_;
  Metrics initial_, metrics_;
  RegistrationResult::Counts counts_;
  DeviceCounts traffic_;  ///< of the last repetition
  double warm_up_ms_ = 0;
  std::vector<Repetition> repetitions_;
};

std::vector<std::unique_ptr<Subject>> make_subjects(const Options& options, Workbench& workbench) {
  const auto folders = data_folders(options.data);
  const MethodSwap swap(workbench.registry(), folders);
  std::vector<std::unique_ptr<Subject>> subjects;
  for (const auto& data : data_sets) {
    if (*data.needs != '\0' && !find_data(folders, data.needs)) {
      fmt::print("{}: skipped, {} was not found; give its folder with --data or PLIANT_DATA\n", data.name,
                 data.needs);
      continue;
    }
    for (const std::string method : methods) {
      if (fmt::format("{} {}", data.name, method).find(options.only) == std::string::npos) continue;
      const auto experiment =
          swap.make(experiments_folder() / data.file, experiments_folder() / "methods" / (method + ".yaml"));
      subjects.push_back(std::make_unique<Subject>(data, method, experiment, workbench));
    }
  }
  return subjects;
}

/// The stages that take most, and the host's time that is none of them.
std::string stages_text(const ordered_json& row) {
  std::vector<std::pair<double, std::string>> stages;
  double rest = row["time_ms"];
  for (const auto& [stage, time] : row["stages_ms"].items()) {
    stages.emplace_back(time.get<double>(), stage);
    rest -= time.get<double>();
  }
  std::sort(stages.rbegin(), stages.rend());
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(stages.size(), 5); ++i) {
    text += fmt::format("{} {:.1f}, ", stages[i].second, stages[i].first);
    stages[i].first = 0;
  }
  double small = 0;
  for (const auto& [time, stage] : stages) small += time;
  return text + fmt::format("smaller ones {:.1f}, outside of stages {:.1f}", small, std::max(rest, 0.0));
}

/// Megabytes, and in how many copies.
std::string traffic_text(const ordered_json& row, const char* copies, const char* bytes) {
  return fmt::format("{:.1f} MB in {}", 1e-6 * row[bytes].get<double>(), row[copies].get<int>());
}

void print(const ordered_json& rows) {
  fmt::print("\n{:<7} {:<17} {:>8} {:>6} {:>6} {:>7} {:>6} {:>9} {:>7}  {:>14} {:>14}  {}\n", "data",
             "method", "ms", "fps", "nodes", "constr.", "rounds", "residual", "EPE", "to device", "to host",
             "where the time goes, ms");
  for (const auto& row : rows)
    fmt::print("{:<7} {:<17} {:>8.1f} {:>6.1f} {:>6} {:>7} {:>6} {:>9.3f} {:>7}  {:>14} {:>14}  {}\n",
               row["data"].get<std::string>(), row["name"].get<std::string>(), row["time_ms"].get<double>(),
               row["fps"].get<double>(), row["nodes"].get<int>(), row["constraints"].get<int>(),
               row["outer_iterations"].get<int>(), row["residual_mean"].get<double>(),
               row["epe_mean"].is_null() ? "-" : fmt::format("{:.3f}", row["epe_mean"].get<double>()),
               traffic_text(row, "uploads", "uploaded_bytes"), traffic_text(row, "reads", "read_bytes"),
               stages_text(row));
}

}  // namespace

int run_pair_mode(const Options& options) {
  Registry registry;
  register_everything(registry);
  Workbench workbench(registry);
  const auto subjects = make_subjects(options, workbench);
  Timings timings;
  for (const auto& subject : subjects) {
    subject->warm_up();
    timings.add(subject->name, {subject->repetitions(options.quick ? 3 : 5), 1},
                [&subject] { subject->repeat(); });
  }
  const auto times = timings.run();
  auto rows = ordered_json::array();
  for (const auto& subject : subjects) rows.push_back(subject->row(times.at(subject->name)));
  print(rows);
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
