#pragma once

#include <filesystem>
#include <vector>

#include "experiments/study/run_row.h"

namespace pliant {

/// What the log of a run in a folder tells of each frame (TrackLog). Of a frame that was not tracked there is
/// its number alone: what else is told of it is not of its own. Nothing where there is no log. Throws
/// DataError naming the file and line of what is no log.
std::vector<Numbers> read_run_frames(const std::filesystem::path& folder);

}  // namespace pliant
