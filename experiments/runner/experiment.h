#pragma once

#include <array>
#include <string>
#include <vector>

#include "framework/config/config.h"
#include "framework/device/device.h"

namespace pliant {

/// The keys of an experiment file.
ParameterTable experiment_table();

/// What an experiment asks of its device. Throws ConfigError for what no device has.
DeviceOptions device_options(const Parameters& experiment);

/// The files that stand beside the folders of several runs, in results of every kind.
inline constexpr std::array files_beside_runs{"experiment.yaml", "result.json", "compare.json", "index.html"};

/// A checked experiment and the registrations, or the edits by handles, that it asks for.
struct ExperimentPlan {
  struct Run {
    std::string name;
    Parameters values;  ///< the whole experiment, with the run's own values laid over it
    std::string place;  ///< where an error of the run came from: the file or text, and its name if not alone
  };

  std::string name;  ///< of the experiment: its `name`, else that of the file or text
  Experiment experiment;
  std::vector<Run> runs;  ///< at least one

  /// Whether its runs bend a surface by handles instead of registering it.
  bool has_handles() const;

  /// Leaves out the runs that `quick` does not list, where it lists any.
  void keep_quick_runs();
};

/// Reads an experiment (see load_experiment). Throws ConfigError with every error of the file, also for
/// names that cannot name a folder.
ExperimentPlan plan_experiment(const ConfigSource& source, const Registry& registry);

}  // namespace pliant
