#include "experiments/report/chart_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double margin_share = 0.06;  ///< of the axis, beyond the outermost values

/// 1, 2 or 5 times a power of ten.
double round_step(double least) {
  const double decade = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * decade >= least * (1 - 1e-9)) return step * decade;
  return 10 * decade;
}

/// Where all values are whole, none is marked between them.
std::vector<double> linear_ticks(double low, double high, bool whole) {
  const double step = std::max(round_step((high - low) / 7), whole ? 1.0 : 0.0);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k * step + 0.0);  // no "-0"
  return ticks;
}

/// Round values between the ends of the axis: whole decades where there are several of them, else the
/// coarsest set that marks enough.
std::vector<double> log_ticks(double low, double high) {
  const std::vector<std::vector<double>> sets{
      {1}, {1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 6, 8}, {1,   1.1, 1.2, 1.3, 1.4, 1.6, 1.8,
                                                           2,   2.2, 2.5, 2.8, 3.2, 3.6, 4,
                                                           4.5, 5,   5.6, 6.3, 7.1, 8,   9}};
  std::vector<double> ticks;
  for (const std::vector<double>& set : sets) {
    ticks.clear();
    for (double decade = std::floor(std::log10(low)); decade <= std::log10(high); ++decade)
      for (const double step : set) {
        const double tick = step * std::pow(10, decade);
        if (tick >= low && tick <= high) ticks.push_back(tick);
      }
    if (ticks.size() >= 3) break;
  }
  return ticks;
}

ChartAxis linear_axis(double least, double most, bool from_zero, bool whole) {
  const double margin =
      most > least ? margin_share * (most - least) : std::max(std::abs(most) * margin_share, 0.5);
  ChartAxis axis{false, least - margin, most + margin, {}};
  // An axis that ends a little below zero would suggest that values may be negative.
  if (least >= 0 && (from_zero || axis.low < 0 || least < 0.35 * most)) axis.low = 0;
  if (most <= 0 && (from_zero || axis.high > 0)) axis.high = 0;
  if (axis.low == axis.high) axis.high = axis.low + 1;
  axis.ticks = linear_ticks(axis.low, axis.high, whole);
  return axis;
}

ChartAxis log_axis(double least, double most) {
  const double margin = std::pow(10, std::max(margin_share * std::log10(most / least), 0.05));
  ChartAxis axis{true, least / margin, most * margin, {}};
  axis.ticks = log_ticks(axis.low, axis.high);
  return axis;
}

}  // namespace

double ChartAxis::place(double value) const {
  return is_log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

bool ChartAxis::takes(double value) const { return std::isfinite(value) && (!is_log || value > 0); }

ChartAxis axis_around(const std::vector<double>& values, bool is_log, bool from_zero) {
  ChartAxis axis{is_log, 0, 1, {}};
  std::vector<double> taken;
  std::copy_if(values.begin(), values.end(), std::back_inserter(taken),
               [&](double value) { return axis.takes(value); });
  if (taken.empty()) return axis;
  const auto [least, most] = std::minmax_element(taken.begin(), taken.end());
  const bool whole =
      std::all_of(taken.begin(), taken.end(), [](double value) { return value == std::round(value); });
  return is_log ? log_axis(*least, *most) : linear_axis(*least, *most, from_zero, whole);
}

std::string tick_label(double value) { return fmt::format("{:.7g}", value); }

}  // namespace pliant
