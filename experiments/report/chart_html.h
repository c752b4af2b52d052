#pragma once

#include <string>

#include "experiments/report/artefacts.h"
#include "experiments/report/study.h"

namespace pliant {

/// Numbers over the steps of a run, on a logarithmic axis.
Chart chart_of(const Series& series);

/// A chart as a figure of a page: drawn, with its title, text and values, and with what the page's script
/// needs to draw it anew.
std::string chart_html(const Chart& chart);

}  // namespace pliant
