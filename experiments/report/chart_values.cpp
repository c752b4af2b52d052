#include "experiments/report/chart_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

using nlohmann::ordered_json;

const char* name_of(Chart::Kind kind) {
  switch (kind) {
    case Chart::Kind::lines:
      return "lines";
    case Chart::Kind::frames:
      return "frames";
    case Chart::Kind::bars:
      return "bars";
    default:
      return "stacked_bars";
  }
}

ordered_json series_json(const Chart& chart, std::size_t number) {
  const Chart::Series& series = chart.series[number];
  ordered_json points = ordered_json::array();
  for (const auto& point : series.points)
    points.push_back({{"x", point.x},
                      {"label", place_text(point)},
                      {"value", point.value},
                      {"spread", point.spread},
                      {"text", value_text(point)}});
  return {{"name", series.name}, {"color", color_of(chart, number)}, {"points", points}};
}

bool is_stacked(const Chart& chart) { return chart.kind == Chart::Kind::stacked_bars; }

/// All heights that must be seen.
std::vector<double> extents(const Chart& chart) {
  if (is_stacked(chart)) return heights_of_stacks(chart);
  std::vector<double> values;
  for (const auto& limit : chart.limits) values.push_back(limit.value);
  for (const auto& series : chart.series)
    for (const auto& point : series.points)
      values.insert(values.end(), {point.value, point.value - point.spread, point.value + point.spread});
  return values;
}

ordered_json axis_json(const ChartAxis& axis, const std::string& label) {
  std::vector<std::string> labels;
  for (const double tick : axis.ticks) labels.push_back(tick_label(tick));
  return {{"label", label},    {"is_log", axis.is_log}, {"low", axis.low},
          {"high", axis.high}, {"ticks", axis.ticks},   {"labels", labels}};
}

/// The places at the axis, each once: over numbers by the number, over words as they come.
std::vector<Chart::Point> places_of(const Chart& chart) {
  const bool by_number = is_over_numbers(chart);
  std::vector<Chart::Point> places;
  for (const auto& series : chart.series)
    for (const auto& point : series.points) {
      const auto is_there = [&](const Chart::Point& other) {
        return by_number ? other.x == point.x : other.label == point.label;
      };
      if (std::none_of(places.begin(), places.end(), is_there)) places.push_back(point);
    }
  if (by_number)
    std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return places;
}

std::string cell(const Chart& chart, const Chart::Series& series, const Chart::Point& place) {
  for (const auto& point : series.points)
    if (is_over_numbers(chart) ? point.x == place.x : point.label == place.label)
      return !std::isfinite(point.value) ? ""
             : point.spread > 0          ? fmt::format("{:.4g} ± {:.2g}", point.value, point.spread)
                                         : fmt::format("{:.4g}", point.value);
  return "";
}

}  // namespace

const std::vector<std::string>& chart_colors() {
  static const std::vector<std::string> names{"blue", "orange", "green", "purple", "ochre",
                                              "pink", "teal",   "grey",  "red"};
  return names;
}

bool is_over_numbers(const Chart& chart) {
  return chart.kind == Chart::Kind::lines || chart.kind == Chart::Kind::frames;
}

std::size_t color_of(const Chart& chart, std::size_t series) {
  constexpr std::size_t given_out = 8;
  return chart.series[series].color.value_or(series % given_out);
}

std::vector<std::string> labels_of(const Chart& chart) {
  std::vector<std::string> labels;
  for (const auto& series : chart.series)
    for (const auto& point : series.points)
      if (std::find(labels.begin(), labels.end(), point.label) == labels.end()) labels.push_back(point.label);
  return labels;
}

std::vector<double> heights_of_stacks(const Chart& chart) {
  const std::vector<std::string> labels = labels_of(chart);
  std::vector<double> heights(labels.size(), 0);
  for (const auto& series : chart.series)
    for (const auto& point : series.points)
      if (std::isfinite(point.value))
        heights[static_cast<std::size_t>(std::find(labels.begin(), labels.end(), point.label) -
                                         labels.begin())] += point.value;
  return heights;
}

ChartAxis y_axis_of(const Chart& chart) {
  return axis_around(extents(chart), chart.log_y && !is_stacked(chart), chart.kind != Chart::Kind::lines);
}

ChartAxis x_axis_of(const Chart& chart) {
  std::vector<double> places;
  for (const auto& series : chart.series)
    for (const auto& point : series.points) places.push_back(point.x);
  return axis_around(places, chart.log_x);
}

std::string value_text(const Chart::Point& point) {
  if (!(point.spread > 0)) return fmt::format("{:.4g}", point.value);
  return fmt::format("{:.4g} ± {:.2g} ({} runs)", point.value, point.spread, point.count);
}

std::string place_text(const Chart::Point& point) {
  return point.label.empty() ? fmt::format("{:.6g}", point.x) : point.label;
}

std::string limit_text(const Chart::Limit& limit) {
  return fmt::format("{}: {:.4g}", limit.name, limit.value);
}

Table values_table(const Chart& chart) {
  Table table;
  table.header.push_back(chart.x_label);
  for (const auto& series : chart.series) table.header.push_back(series.name);
  for (const auto& place : places_of(chart)) {
    Table::Row row{{place_text(place)}};
    for (const auto& series : chart.series) row.cells.push_back(cell(chart, series, place));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table values_table(const Study& study) {
  Table table{study.title, {"chart", "series", "x", "label", "value", "spread", "count"}, {}};
  for (const auto& chart : study.charts)
    for (const auto& series : chart.series)
      for (const auto& point : series.points)
        table.rows.push_back(
            {{chart.name, series.name, fmt::format("{}", point.x), point.label,
              fmt::format("{}", point.value), fmt::format("{}", point.spread), std::to_string(point.count)}});
  return table;
}

ordered_json chart_json(const Chart& chart) {
  ordered_json series = ordered_json::array();
  for (std::size_t i = 0; i < chart.series.size(); ++i) series.push_back(series_json(chart, i));
  ordered_json limits = ordered_json::array();
  for (const auto& limit : chart.limits)
    limits.push_back({{"text", limit_text(limit)}, {"value", limit.value}});
  return {{"kind", name_of(chart.kind)},
          {"x", axis_json(x_axis_of(chart), chart.x_label)},
          {"y", axis_json(y_axis_of(chart), chart.y_label)},
          {"labels", labels_of(chart)},
          {"series", series},
          {"limits", limits}};
}

}  // namespace pliant
