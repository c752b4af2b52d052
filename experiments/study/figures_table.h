#pragma once

#include <string>
#include <vector>

#include "experiments/report/table.h"
#include "experiments/study/run_row.h"
#include "framework/core/parameters.h"

namespace pliant {

/// The keys of a table.
ParameterTable figures_table();

/// A table as a section describes it: a row for each combination of values on its axes, in each cell the mean
/// over all runs there. Numbers that no run has are told in `notes`. Throws ConfigError as make_study does.
Table make_figures_table(const std::string& name, const Parameters& section, const std::vector<RunRow>& rows,
                         const FramesOf& frames_of, std::vector<std::string>& notes);

}  // namespace pliant
