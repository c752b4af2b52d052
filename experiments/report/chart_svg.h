#pragma once

#include <string>

#include "experiments/report/study.h"

namespace pliant {

/// A chart as an SVG element. Its colours are CSS variables of the page it is in (web/chart.css), which
/// follow the reader's choice of light or dark, and light ones where nothing knows of CSS. Whiskers are one
/// `spread` long either way, where that is above 0. A value that its axis does not take (not finite, or not
/// positive on a logarithmic one) is left out; stacked bars are linear whatever the chart says.
std::string chart_svg(const Chart& chart);

/// The same as the text of a file of its own.
std::string chart_svg_file(const Chart& chart);

}  // namespace pliant
