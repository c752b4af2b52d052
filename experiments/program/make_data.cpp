#include "experiments/program/make_data.h"

#include <filesystem>

#include "experiments/datasets/frame_source.h"
#include "experiments/datasets/sequence_writer.h"
#include "experiments/program/output.h"
#include "experiments/program/progress_line.h"
#include "experiments/runner/components.h"
#include "experiments/runner/experiment.h"
#include "experiments/runner/result_folder.h"
#include "experiments/tasks/workbench.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// What of an experiment says where frames come from.
struct Data {
  std::string name;
  Parameters values;  ///< has data, seed, device and kernels
  std::vector<fs::path> files;
};

Data read_data(const ExperimentOptions& options, const Registry& registry) {
  ConfigSource source = config_source(options);
  if (registry.find(FrameSource::kind, options.file) == nullptr) {
    ExperimentPlan plan = plan_experiment(source, registry);
    return {plan.name, std::move(plan.experiment.values), std::move(plan.experiment.files)};
  }
  source.from = ConfigText{"data: " + options.file + "\n", options.file, ""};
  const ParameterTable whole = experiment_table();
  std::vector<Parameter> rows;
  for (const char* key : {"data", "seed", "device", "kernels"}) rows.push_back(*whole.find(key));
  Experiment experiment = load_experiment(source, ParameterTable(std::move(rows)), registry);
  return {options.file, std::move(experiment.values), std::move(experiment.files)};
}

}  // namespace

void make_data_command(const ExperimentOptions& options, const std::string& layout) {
  Registry registry;
  register_everything(registry);
  const Data data = read_data(options, registry);
  const fs::path folder = options.out.empty() ? fs::path("out") / data.name : fs::path(options.out);
  Workbench workbench(registry, show_line);
  const auto stream =
      registry.make<FrameSource>(data.values.section("data"))
          ->open(workbench.device(data.values), static_cast<std::uint64_t>(data.values.integer("seed")));
  ResultFolder result(
      folder, {"intrinsics.txt", "depth.txt", "rgb.txt", "groundtruth.txt", "associations.txt"}, data.files);
  ProgressLine line;
  const WrittenSequence written =
      write_sequence(*stream, layout == "tum" ? SequenceLayout::tum : SequenceLayout::deepdeform,
                     result.unfinished(), line.sink());
  line.clear();
  result.commit();
  for (const auto& warning : stream->warnings()) print("warning: {}\n", warning);
  print("{} frames of {} are in {}\n", written.frames, stream->name(), folder.string());
  if (written.lost) std::rethrow_exception(written.lost);
}

}  // namespace pliant
