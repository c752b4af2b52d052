#pragma once

#include <string>
#include <vector>

#include "experiments/report/study.h"
#include "experiments/study/measure.h"

namespace pliant {

/// The value of a measure at each frame of the runs that meet the conditions: the mean of all that have it
/// there, NaN where none has. In the order of the frames. A name that no frame has is told in `missing`.
std::vector<Chart::Point> frame_points(const Measure& measure, const std::vector<std::string>& conditions,
                                       std::string& missing);

}  // namespace pliant
