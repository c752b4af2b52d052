#pragma once

#include <string>
#include <vector>

#include "experiments/report/study.h"
#include "experiments/study/run_row.h"
#include "framework/core/parameters.h"

namespace pliant {

/// The keys of a chart.
ParameterTable chart_table();

/// A chart as a section describes it: a point for each value on its axis, or for each frame, the mean over
/// all runs there. Numbers that no run has are told in `notes`. Throws ConfigError as make_study does, and
/// for an axis whose values are no numbers where the chart needs some.
Chart make_chart(const std::string& name, const Parameters& section, const std::vector<RunRow>& rows,
                 const FramesOf& frames_of, std::vector<std::string>& notes);

}  // namespace pliant
