#pragma once

#include <string>

#include "experiments/report/report.h"

namespace pliant {

/// One run as an HTML page that needs no other file: tables, plots and pictures, and the run in three
/// dimensions where there is such a view and `with_view` asks for it.
std::string make_page(const RunArtefacts& run, bool with_view = true);

}  // namespace pliant
