#pragma once

#include <string>
#include <vector>

#include "experiments/report/study.h"

namespace pliant {

/// What all studies found, in one table whose rows lead to their places; nothing without any finding.
std::string findings_summary_html(const std::vector<Study>& studies);

/// What one study found, each with its condition and the numbers in it.
std::string findings_html(const Study& study);

}  // namespace pliant
