#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report/chart_axis.h"
#include "experiments/report/study.h"

namespace pliant {

/// Whether its axis has numbers, else words.
bool is_over_numbers(const Chart& chart);

/// Which of the page's colours a series has.
std::size_t color_of(const Chart& chart, std::size_t series);

/// The words at the axis of bars: of all series, in the order in which they come.
std::vector<std::string> labels_of(const Chart& chart);

/// How high the stacks are, in the order of labels_of.
std::vector<double> heights_of_stacks(const Chart& chart);

/// The axis over which values lie, and the one over numbers, `Point::x`.
ChartAxis y_axis_of(const Chart& chart);
ChartAxis x_axis_of(const Chart& chart);

/// "1.25", or "1.25 ± 0.1 (10 runs)" where a spread is known.
std::string value_text(const Chart::Point& point);

/// What stands at the axis under a point: its label, or its number where it has none.
std::string place_text(const Chart::Point& point);

/// "threshold: 2"
std::string limit_text(const Chart::Limit& limit);

/// One row a place at the axis, one column a series.
Table values_table(const Chart& chart);

/// Every value of every chart of a study in a row of its own: chart, series, x, label, value, spread, count.
Table values_table(const Study& study);

/// What the page's script draws.
nlohmann::ordered_json chart_json(const Chart& chart);

}  // namespace pliant
