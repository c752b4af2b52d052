#pragma once

#include <string>
#include <vector>

#include "experiments/datasets/sequence.h"

namespace pliant {

/// The frames of a folder in the TUM layout, in the order of time, and what is odd about its lists.
struct TumFrames {
  std::vector<Sequence::Item> frames;
  std::vector<std::string> warnings;
};

/// From `associations.txt` where there is one, whichever of both images comes first in a line (the file whose
/// path has "depth" in it is the depth). Otherwise from `depth.txt` and `rgb.txt`: each depth goes with the
/// colour nearest in time, at most 20 ms apart, each used once, the nearest first; depth without is left out.
/// Without `rgb.txt` there is no colour. A frame's time is that of its depth, in seconds from the first
/// frame's on; its camera's pose is that of `groundtruth.txt` (TumPoses), where there is one, at the time of
/// the depth. Throws DataError naming file and line.
TumFrames read_tum_lists(const std::string& folder);

}  // namespace pliant
