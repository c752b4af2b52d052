#pragma once

#include <vector>

#include "experiments/report/study.h"
#include "experiments/study/run_row.h"
#include "framework/core/parameters.h"

namespace pliant {

/// The keys of a claim.
ParameterTable claim_table();

/// What the runs say of a claim: once, or once for each value on the axis `each`. Throws ConfigError as
/// make_study does, and for a condition over names that are no values of the claim.
std::vector<Finding> make_findings(const Parameters& section, const std::vector<RunRow>& rows,
                                   const FramesOf& frames_of);

}  // namespace pliant
