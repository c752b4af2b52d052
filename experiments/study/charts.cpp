#include "experiments/study/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include "experiments/study/measure.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

ParameterTable series_table() {
  std::vector<Parameter> rows = Measure::rows();
  rows.push_back(text("by").optional().doc("an axis: a series of its own for each value on it"));
  return ParameterTable(std::move(rows));
}

std::optional<double> parse(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

Chart::Kind kind_of(const std::string& name) {
  if (name == "bars") return Chart::Kind::bars;
  if (name == "stacked_bars") return Chart::Kind::stacked_bars;
  return Chart::Kind::lines;
}

/// Makes the series of one chart.
class ChartMaker {
 public:
  ChartMaker(const Parameters& section, const std::vector<RunRow>& rows)
      : section_(section), rows_(rows), where_(section.words("where")), axis_(section.text("over")) {
    check_conditions(where_, rows, section.place());
    labels_ = values_on(axis_, rows, section.place());
    if (!section.has("x")) return;
    x_.emplace(section.text("x"), section.place());
  }

  std::vector<Chart::Series> series(const std::string& name, const Parameters& section,
                                    std::vector<std::string>& notes) const {
    const Measure measure(section, rows_);
    if (const std::string missing = measure.missing(); !missing.empty())
      notes.push_back(fmt::format("{}: {}", section.place(), missing));
    if (!section.has("by")) return {{name, points(measure, where_)}};
    const bool is_alone = section_.sections("series").size() == 1;
    std::vector<Chart::Series> all;
    for (const std::string& value : values_on(section.text("by"), rows_, section.place())) {
      std::vector<std::string> conditions = where_;
      conditions.push_back(condition(section.text("by"), value));
      all.push_back({is_alone ? value : fmt::format("{}, {}", value, name), points(measure, conditions)});
    }
    std::erase_if(all, [&](const Chart::Series& each) { return each.points.empty() && has_numbers(); });
    return all;
  }

 private:
  bool has_numbers() const {
    return std::any_of(rows_.begin(), rows_.end(), [](const RunRow& row) { return !row.numbers.empty(); });
  }

  std::vector<Chart::Point> points(const Measure& measure, const std::vector<std::string>& conditions) const {
    std::vector<Chart::Point> points;
    for (const std::string& label : labels_) {
      std::vector<std::string> here = conditions;
      here.push_back(condition(axis_, label));
      const std::optional<double> x = place_of(label, here);
      const Sample sample = measure.sample(here);
      if (x && sample.count() > 0)
        points.push_back({*x, label, sample.mean(), sample.deviation(), sample.count()});
    }
    if (section_.text("kind") == "lines")
      std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    return points;
  }

  /// Where a value on the axis is drawn.
  std::optional<double> place_of(const std::string& label, const std::vector<std::string>& conditions) const {
    if (x_) {
      const Sample sample(*x_, rows_, RowFilter(conditions, rows_, section_.place()));
      return sample.count() > 0 ? std::optional(sample.mean()) : std::nullopt;
    }
    const std::optional<double> number = parse(label);
    if (number || section_.text("kind") != "lines") return number.value_or(0);
    throw ConfigError(
        fmt::format("{}: '{}' on the axis '{}' is no number; expected numbers, 'x' or kind: bars",
                    section_.place(), label, axis_));
  }

  const Parameters& section_;
  const std::vector<RunRow>& rows_;
  std::vector<std::string> where_;
  std::string axis_;
  std::vector<std::string> labels_;
  std::optional<Expression> x_;
};

}  // namespace

ParameterTable chart_table() {
  return {
      choice("kind", {"lines", "bars", "stacked_bars"}, "lines").doc("how values are drawn"),
      text("title").doc("with the number that the figure has in a paper"),
      text("text", "").doc("what it shows, in a sentence or two"),
      text("over").doc("the axis of the sweep whose values its points have; `run` for the entries of `runs`"),
      text("x").optional().doc("a formula for where points are drawn; the values on the axis by default"),
      text("x_label", "").doc("with its unit; the axis by default"),
      text("y_label").doc("with its unit"),
      boolean("log_x", false).doc("a logarithmic axis"),
      boolean("log_y", false).doc("a logarithmic axis"),
      words("where").optional().doc("only of the runs that have AXIS=VALUE"),
      groups("series", series_table()).at_least(1).doc("what is drawn, by name"),
  };
}

Chart make_chart(const std::string& name, const Parameters& section, const std::vector<RunRow>& rows,
                 std::vector<std::string>& notes) {
  Chart chart;
  chart.name = name;
  chart.title = section.text("title");
  chart.text = section.text("text");
  chart.kind = kind_of(section.text("kind"));
  chart.x_label = section.text("x_label").empty() ? section.text("over") : section.text("x_label");
  chart.y_label = section.text("y_label");
  chart.log_x = section.boolean("log_x");
  chart.log_y = section.boolean("log_y");
  const ChartMaker maker(section, rows);
  for (const auto& [label, series] : section.sections("series"))
    for (Chart::Series& one : maker.series(label, series, notes)) chart.series.push_back(std::move(one));
  return chart;
}

}  // namespace pliant
