#pragma once

#include <array>
#include <vector>

#include "experiments/report/study.h"
#include "experiments/study/run_row.h"
#include "framework/core/parameters.h"

namespace pliant {

/// What an experiment file may say in `study` of how its runs are shown together (experiments/README.md):
/// charts, tables, claims, pictures and views.
ParameterTable study_table();

/// The keys of such a section that show anything.
inline constexpr std::array study_parts{"charts", "tables", "claims", "pictures", "views"};

/// The charts, tables, findings, pictures and views that a `study` section asks for, and notes of what no run
/// has. Rows without numbers do to find out whether it can be made. Frames are asked for only where a chart
/// is over them, and the files of pictures and views are those below the folder of all runs. Throws
/// ConfigError for what is no formula, and for axes and values that no run has.
Study make_study(
    const Parameters& section, const std::vector<RunRow>& rows,
    const FramesOf& frames_of = [](const RunRow&) { return std::vector<Numbers>(); });

/// All numbers of all runs, a row a run: its name, its values on the axes, then every number that a run has.
Table all_numbers(const std::vector<RunRow>& rows);

}  // namespace pliant
