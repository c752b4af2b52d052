#include "experiments/report/chart_values.h"

#include <fmt/format.h>

#include <algorithm>

namespace pliant {
namespace {

using nlohmann::ordered_json;

const char* name_of(Chart::Kind kind) {
  switch (kind) {
    case Chart::Kind::lines:
      return "lines";
    case Chart::Kind::bars:
      return "bars";
    default:
      return "stacked_bars";
  }
}

ordered_json series_json(const Chart::Series& series) {
  ordered_json points = ordered_json::array();
  for (const auto& point : series.points)
    points.push_back({{"x", point.x},
                      {"label", place_text(point)},
                      {"value", point.value},
                      {"spread", point.spread},
                      {"text", value_text(point)}});
  return {{"name", series.name}, {"points", points}};
}

/// The places at the axis, each once: over numbers by the number, over words as they come.
std::vector<Chart::Point> places_of(const Chart& chart) {
  const bool by_number = chart.kind == Chart::Kind::lines;
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
    if (chart.kind == Chart::Kind::lines ? point.x == place.x : point.label == place.label)
      return point.spread > 0 ? fmt::format("{:.4g} ± {:.2g}", point.value, point.spread)
                              : fmt::format("{:.4g}", point.value);
  return "";
}

}  // namespace

std::vector<std::string> labels_of(const Chart& chart) {
  std::vector<std::string> labels;
  for (const auto& series : chart.series)
    for (const auto& point : series.points)
      if (std::find(labels.begin(), labels.end(), point.label) == labels.end()) labels.push_back(point.label);
  return labels;
}

std::string value_text(const Chart::Point& point) {
  if (!(point.spread > 0)) return fmt::format("{:.4g}", point.value);
  return fmt::format("{:.4g} ± {:.2g} ({} runs)", point.value, point.spread, point.count);
}

std::string place_text(const Chart::Point& point) {
  return point.label.empty() ? fmt::format("{:.6g}", point.x) : point.label;
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
  for (const auto& one : chart.series) series.push_back(series_json(one));
  return {{"kind", name_of(chart.kind)}, {"x_label", chart.x_label}, {"y_label", chart.y_label},
          {"log_x", chart.log_x},        {"log_y", chart.log_y},     {"series", series}};
}

}  // namespace pliant
