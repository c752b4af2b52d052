#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/task.h"
#include "experiments/tasks/track_summary.h"

namespace pliant {

/// How the stream of a run ended.
struct StreamEnd {
  std::vector<std::string> warnings;  ///< what was odd about it
  std::string error = {};             ///< what broke it; empty: it ended, or was ended
};

/// What there is to show of frames that were tracked.
RunArtefacts track_artefacts(const ExperimentRun& run, const TrackSummary& summary, const StreamEnd& end);

}  // namespace pliant
