#pragma once

#include <vector>

#include "experiments/report/study.h"

namespace pliant {

/// Mean and spread of ten made-up runs each, over numbers: two series that fall.
Chart sample_lines();

/// Two series over three words.
/// Two series over 60 frames, of which one was lost for a while, and a threshold.
Chart sample_frames();
Chart sample_bars(Chart::Kind kind);

/// Two made-up studies that have everything a page can show but views.
std::vector<Study> sample_studies();

}  // namespace pliant
