#pragma once

#include <memory>
#include <string>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/workbench.h"
#include "framework/core/log.h"
#include "framework/core/parameters.h"
#include "framework/registration/edit.h"
#include "framework/tracking/method.h"

namespace pliant {

/// One run of an experiment.
struct ExperimentRun {
  std::string name;
  Parameters values;  ///< the whole experiment, with the run's own values laid over it
  std::string place;  ///< where an error of the run came from: the file or text, and its name if not alone
};

/// Turns a run of an experiment into artefacts.
class Task {
 public:
  virtual ~Task() = default;

  /// The file of all runs' numbers.
  virtual std::string result_file() const { return "result.json"; }
  /// What the page over all runs says of them.
  virtual std::string lead() const { return "One row a run; each name leads to its page."; }
  /// Whether the experiment's reports show each run; else there is only the page over all of them.
  virtual bool is_reported() const { return true; }
  /// Of all artefacts that make() may give.
  virtual ArtefactNames names() const = 0;

  /// Tries everything short of the work. Throws what make() would.
  virtual void check(const ExperimentRun& run, Workbench& workbench) const = 0;
  /// With `repeats` above 0 the work is done once untimed, then so many times, and the median time is told.
  /// `progress` is there, and tells under the run's name. Throws an Error that tells the place of the run or
  /// of what is wrong.
  virtual RunArtefacts make(const ExperimentRun& run, Workbench& workbench, const ProgressSink& progress,
                            int repeats) const = 0;
};

/// What `pliant run` does with an experiment: `register`, or `edit` where it has handles.
std::unique_ptr<Task> make_task(const Parameters& experiment);

std::unique_ptr<Task> make_register_task();
std::unique_ptr<Task> make_edit_task();
/// Freezes the first problem of each run and lets every solver of `solvers` minimise an identical one from
/// the same start. A run fails with ConfigError when it lists no solvers, with NumericalError when one of
/// them finds no finite answer.
std::unique_ptr<Task> make_compare_task();

/// Tells the same with `label` before what is said.
ProgressSink labelled(const ProgressSink& progress, const std::string& label);

/// How `pliant compare` measures.
ParameterTable compare_table();

/// The handles of a run, by name.
NamedHandles make_handles(const ExperimentRun& run, const Registry& registry);

/// The method of a run. Throws ConfigError for a combination that makes no sense, also of energies and
/// handles.
Method make_method(const ExperimentRun& run, const Registry& registry);

}  // namespace pliant
