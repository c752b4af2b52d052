#include "experiments/report/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pliant {
namespace {

constexpr double width = 560;
constexpr double height = 300;
constexpr double left = 76;
constexpr double right = 20;
constexpr double top = 16;
constexpr double bottom = 52;

/// Index and decimal logarithm of the values that have one.
using Points = std::vector<std::pair<double, double>>;

Points logarithms(const std::vector<double>& values) {
  Points points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i]) && values[i] > 0)
      points.emplace_back(static_cast<double>(i), std::log10(values[i]));
  }
  return points;
}

struct Axes {
  double last_index = 1;
  double lowest = 0;  // decimal logarithms
  double highest = 1;

  double x(double index) const { return left + index / last_index * (width - left - right); }
  double y(double logarithm) const {
    return height - bottom - (logarithm - lowest) / (highest - lowest) * (height - top - bottom);
  }
};

Axes axes_around(const Points& points) {
  Axes axes{std::max(points.back().first, 1.0), points[0].second, points[0].second};
  for (const auto& [index, logarithm] : points) {
    axes.lowest = std::min(axes.lowest, logarithm);
    axes.highest = std::max(axes.highest, logarithm);
  }
  const double air = std::max(0.08 * (axes.highest - axes.lowest), 0.05);
  axes.lowest -= air;
  axes.highest += air;
  return axes;
}

/// Round values between the ends of the axis: whole decades where there are several of them, else the
/// finest set that leaves room for the labels.
std::vector<double> value_ticks(const Axes& axes) {
  const std::vector<std::vector<double>> sets{
      {1}, {1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 6, 8}, {1,   1.1, 1.2, 1.3, 1.4, 1.6, 1.8,
                                                           2,   2.2, 2.5, 2.8, 3.2, 3.6, 4,
                                                           4.5, 5,   5.6, 6.3, 7.1, 8,   9}};
  std::vector<double> ticks;
  for (const std::vector<double>& set : sets) {
    ticks.clear();
    for (double decade = std::floor(axes.lowest); decade <= axes.highest; ++decade) {
      for (const double step : set) {
        const double logarithm = decade + std::log10(step);
        if (logarithm >= axes.lowest && logarithm <= axes.highest)
          ticks.push_back(step * std::pow(10, decade));
      }
    }
    if (ticks.size() >= 3) break;
  }
  return ticks;
}

std::string value_axis(const Axes& axes, const std::string& label) {
  std::string svg;
  for (const double tick : value_ticks(axes)) {
    const double y = axes.y(std::log10(tick));
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:.4g}</text>\n",
        left, width - right, y, left - 8, y + 4, tick);
  }
  return svg + fmt::format(
                   "<text class=\"label\" transform=\"translate(16 {:.1f}) rotate(-90)\" "
                   "text-anchor=\"middle\">{}</text>\n",
                   (top + height - bottom) / 2, label);
}

std::string index_axis(const Axes& axes, const std::string& label) {
  const double step = std::max(1.0, std::ceil(axes.last_index / 12));
  std::string svg;
  for (double index = 0; index <= axes.last_index; index += step) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{:.0f}</text>\n", axes.x(index),
                       height - bottom + 20, index);
  }
  return svg + fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                           (left + width - right) / 2, height - 8, label);
}

std::string curve(const Axes& axes, const Points& points, const std::vector<double>& values) {
  std::string line;
  std::string dots;
  for (const auto& [index, logarithm] : points) {
    line += fmt::format("{:.1f},{:.1f} ", axes.x(index), axes.y(logarithm));
    dots +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"><title>{:.0f}: {:.6g}</title></circle>\n",
                    axes.x(index), axes.y(logarithm), index, values[static_cast<std::size_t>(index)]);
  }
  return fmt::format("<polyline points=\"{}\"/>\n{}", line, dots);
}

}  // namespace

std::string log_plot_svg(const std::vector<double>& values, const std::string& x_label,
                         const std::string& y_label) {
  const Points points = logarithms(values);
  if (points.empty()) return "<p>No positive value to plot.</p>\n";
  const Axes axes = axes_around(points);
  return fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width,
                     height, y_label) +
         value_axis(axes, y_label) + index_axis(axes, x_label) + curve(axes, points, values) + "</svg>\n";
}

}  // namespace pliant
