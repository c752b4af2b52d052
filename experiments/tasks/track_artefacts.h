#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/task.h"
#include "experiments/tasks/track_summary.h"
#include "framework/pose/focal_length.h"

namespace pliant {

/// How the tracking of a stream ended.
struct TrackEnd {
  std::vector<std::string> warnings;  ///< what was odd about the stream
  std::string error = {};             ///< what broke it; empty: it ended, or was ended
  bool is_ended = false;              ///< whether somebody ended it before the stream did
  std::optional<ModelError> model_error = {};
  FocalLengthEstimate focal_length = {};
};

/// What there is to show of frames that were tracked.
RunArtefacts track_artefacts(const ExperimentRun& run, const TrackSummary& summary, const TrackEnd& end);

}  // namespace pliant
