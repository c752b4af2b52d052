#pragma once

#include <string>
#include <vector>

namespace pliant {

/// Values against their index (0, 1, ...) as an SVG element with a logarithmic, labelled y axis.
/// Colours are the page's (CSS `currentColor` and `--accent`). Values that a logarithm does not take
/// are left out; without any other, a line of text says so.
std::string log_plot_svg(const std::vector<double>& values, const std::string& x_label,
                         const std::string& y_label);

}  // namespace pliant
