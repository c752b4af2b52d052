#pragma once

#include <vector>

#include "experiments/report/study.h"

namespace pliant {

/// Mean and spread of ten made-up runs each, over numbers: two series that fall.
Chart sample_lines();

/// Two series over three words.
Chart sample_bars(Chart::Kind kind);

/// Two made-up studies that have everything a page can show but views.
std::vector<Study> sample_studies();

}  // namespace pliant
