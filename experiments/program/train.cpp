#include "experiments/program/train.h"

#include "experiments/program/output.h"
#include "experiments/training/head_forest_training.h"
#include "framework/core/stopwatch.h"
#include "framework/io/file.h"

namespace pliant {

void train_command(const ExperimentOptions& options) {
  const std::string name = "head_forest";
  ConfigSource source = config_source(options);
  if (options.file == name) source.from = ConfigText{"{}\n", name, ""};
  const Experiment settings = load_experiment(source, head_forest_training_table(), Registry());
  const HeadForestTraining training = read_head_forest_training(settings.values);
  const std::string out = options.out.empty() ? name + ".forest" : options.out;
  const Stopwatch watch;
  print("rendering {} views of {} heads\n", training.views, training.heads);
  const HeadPatches patches = draw_head_patches(training);
  print("growing {} trees on {} patches, and {} on {} of whole heads\n", training.voting.count,
        patches.voting.size(), training.refining.count, patches.refining.size());
  const auto bytes = write_head_forest(grow_head_forest(patches, training));
  write_file(out, bytes);
  print("{}: {} bytes, after {:.0f} s\n", out, bytes.size(), watch.milliseconds() / 1000);
}

}  // namespace pliant
