#pragma once

#include <string>

#include "experiments/report/study.h"

namespace pliant {

/// A chart as a figure of a page: drawn, with its title, text and values, and with what the page's script
/// needs to draw it anew.
std::string chart_html(const Chart& chart);

}  // namespace pliant
