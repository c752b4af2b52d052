#pragma once

#include <string>
#include <vector>

#include "experiments/report/html.h"
#include "experiments/report/study.h"

namespace pliant {

/// Several studies on one page: what all of them found, then each with its charts, tables, findings,
/// pictures, views, notes, experiment and environment. Throws DataError when the file of a picture or view
/// cannot be read.
Page study_page(const std::string& title, const std::string& lead, const std::vector<Study>& studies);

/// The same as an HTML file that needs no other.
std::string make_study_page(const std::string& title, const std::string& lead,
                            const std::vector<Study>& studies);

}  // namespace pliant
