#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/workbench.h"
#include "experiments/view/track_observer.h"
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

/// How a run is made.
struct Making {
  ProgressSink progress;  ///< is there, and tells under the run's name
  /// Above 0 the work is done once untimed, then so many times, and the median time is told.
  int repeats = 0;
  std::filesystem::path folder = {};   ///< where the run's results are to be; it exists
  std::function<void()> keep = [] {};  ///< from then on what is in `folder` outlasts whatever ends this
  std::function<bool()> is_ended = [] { return false; };  ///< whether to end early, with what there is
  TrackObserver* observer = nullptr;                      ///< watches the frames of a stream, if it is there
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

  /// Whether its work goes on until there is no more data, and an interruption means that there is enough.
  virtual bool can_end_early() const { return false; }

  /// Tries everything short of the work. Throws what make() would. Gives what is odd about the data, a line
  /// each.
  virtual std::vector<std::string> check(const ExperimentRun& run, Workbench& workbench) const = 0;
  /// Throws an Error that tells the place of the run or of what is wrong.
  virtual RunArtefacts make(const ExperimentRun& run, Workbench& workbench, const Making& making) const = 0;
};

/// What `pliant run` does with an experiment: `track` where it has a model, `edit` where it has handles, else
/// `register`.
std::unique_ptr<Task> make_task(const Parameters& experiment);

std::unique_ptr<Task> make_register_task();
std::unique_ptr<Task> make_edit_task();
/// Tracks the frames of the data one after the other. Writes what it finds of each while it goes on.
std::unique_ptr<Task> make_track_task();
/// Freezes the first problem of each run and lets every solver of `solvers` minimise an identical one from
/// the same start. A run fails with ConfigError when it lists no solvers, with NumericalError when one of
/// them finds no finite answer.
std::unique_ptr<Task> make_compare_task();

/// Tells the same with `label` before what is said.
ProgressSink labelled(const ProgressSink& progress, const std::string& label);

/// How `pliant compare` measures.
ParameterTable compare_table();

/// What is kept of frames that are tracked, to look at.
ParameterTable record_table();

/// The handles of a run, by name.
NamedHandles make_handles(const ExperimentRun& run, const Registry& registry);

/// The method of a run. Throws ConfigError for a combination that makes no sense, also of energies and
/// handles.
Method make_method(const ExperimentRun& run, const Registry& registry);

}  // namespace pliant
