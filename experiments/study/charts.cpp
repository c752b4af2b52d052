#include "experiments/study/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <optional>

#include "experiments/study/frame_points.h"
#include "experiments/study/measure.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

ParameterTable series_table() {
  std::vector<Parameter> rows = Measure::rows();
  rows.push_back(text("by").optional().doc("an axis: a series of its own for each value on it"));
  rows.push_back(choice("color", chart_colors()).optional().doc("given out in turn by default"));
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
  if (name == "frames") return Chart::Kind::frames;
  if (name == "stacked_bars") return Chart::Kind::stacked_bars;
  return Chart::Kind::lines;
}

using Conditions = std::vector<std::string>;

bool is_over_frames(const Parameters& section) { return section.text("kind") == "frames"; }

void check_keys(const Parameters& section) {
  if (!is_over_frames(section)) {
    if (!section.has("over"))
      throw ConfigError(section.place() + ": 'over' is missing; expected an axis of the sweep");
    return;
  }
  for (const char* key : {"over", "x"})
    if (section.has(key))
      throw ConfigError(fmt::format("{}: '{}' has no place in a chart over frames", section.place(), key));
}

/// Makes the series of one chart.
class ChartMaker {
 public:
  ChartMaker(const Parameters& section, const std::vector<RunRow>& rows, const FramesOf& frames_of)
      : section_(section), rows_(rows), frames_of_(frames_of), where_(section.words("where")) {
    check_conditions(where_, rows, section.place());
    if (is_over_frames(section)) return;
    axis_ = section.text("over");
    labels_ = values_on(axis_, rows, section.place());
    if (section.has("x")) x_.emplace(section.text("x"), section.place());
  }

  std::vector<Chart::Series> series(const std::string& name, const Parameters& section,
                                    std::vector<std::string>& notes) const {
    const Measure measure(section, rows_, frames_of_);
    std::string missing = is_over_frames(section_) ? "" : measure.missing();
    const auto color = color_of(section);
    std::vector<Chart::Series> all;
    if (!section.has("by")) {
      all.push_back({name, points(measure, where_, missing), color});
    } else {
      const bool is_alone = section_.sections("series").size() == 1;
      for (const std::string& value : values_on(section.text("by"), rows_, section.place())) {
        Conditions conditions = where_;
        conditions.push_back(condition(section.text("by"), value));
        all.push_back({is_alone ? value : fmt::format("{}, {}", value, name),
                       points(measure, conditions, missing), color});
      }
      std::erase_if(all, [&](const Chart::Series& each) { return each.points.empty() && has_numbers(); });
    }
    if (!missing.empty()) notes.push_back(fmt::format("{}: {}", section.place(), missing));
    return all;
  }

  /// None where no run has its number.
  std::optional<Chart::Limit> limit(const std::string& name, const Parameters& section,
                                    std::vector<std::string>& notes) const {
    const Measure measure(section, rows_, frames_of_);
    if (const std::string missing = measure.missing(); !missing.empty())
      notes.push_back(fmt::format("{}: {}", section.place(), missing));
    const Sample sample = measure.sample(where_);
    return sample.count() > 0 ? std::optional(Chart::Limit{name, sample.mean()}) : std::nullopt;
  }

 private:
  bool has_numbers() const {
    return std::any_of(rows_.begin(), rows_.end(), [](const RunRow& row) { return !row.numbers.empty(); });
  }

  static std::optional<std::size_t> color_of(const Parameters& section) {
    if (!section.has("color")) return {};
    const auto& colors = chart_colors();
    return std::find(colors.begin(), colors.end(), section.text("color")) - colors.begin();
  }

  std::vector<Chart::Point> points(const Measure& measure, const Conditions& conditions,
                                   std::string& missing) const {
    return is_over_frames(section_) ? frame_points(measure, conditions, missing)
                                    : points_over_axis(measure, conditions);
  }

  std::vector<Chart::Point> points_over_axis(const Measure& measure, const Conditions& conditions) const {
    std::vector<Chart::Point> points;
    for (const std::string& label : labels_) {
      Conditions here = conditions;
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
  std::optional<double> place_of(const std::string& label, const Conditions& conditions) const {
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
  const FramesOf& frames_of_;
  Conditions where_;
  std::string axis_;  // empty: over frames
  std::vector<std::string> labels_;
  std::optional<Expression> x_;
};

std::string x_label_of(const Parameters& section) {
  if (!section.text("x_label").empty()) return section.text("x_label");
  return is_over_frames(section) ? "frame" : section.text("over");
}

}  // namespace

ParameterTable chart_table() {
  return {
      choice("kind", {"lines", "bars", "stacked_bars", "frames"}, "lines")
          .doc("how values are drawn; `frames`: those of each frame that was tracked (frames.jsonl), frame "
               "by frame"),
      text("title").doc("with the number that the figure has in a paper"),
      text("text", "").doc("what it shows, in a sentence or two"),
      text("over").optional().doc("the axis of the sweep whose values its points have; `run` for the entries "
                                  "of `runs`; frames have none"),
      text("x").optional().doc("a formula for where points are drawn; the values on the axis by default"),
      text("x_label", "").doc("with its unit; the axis by default"),
      text("y_label").doc("with its unit"),
      boolean("log_x", false).doc("a logarithmic axis"),
      boolean("log_y", false).doc("a logarithmic axis"),
      words("where").optional().doc("only of the runs that have AXIS=VALUE"),
      groups("series", series_table()).at_least(1).doc("what is drawn, by name"),
      groups("limits", ParameterTable(Measure::rows()))
          .optional()
          .doc("numbers to hold all of it against, by name: dashed across the plot"),
  };
}

Chart make_chart(const std::string& name, const Parameters& section, const std::vector<RunRow>& rows,
                 const FramesOf& frames_of, std::vector<std::string>& notes) {
  check_keys(section);
  Chart chart;
  chart.name = name;
  chart.title = section.text("title");
  chart.text = section.text("text");
  chart.kind = kind_of(section.text("kind"));
  chart.x_label = x_label_of(section);
  chart.y_label = section.text("y_label");
  chart.log_x = section.boolean("log_x");
  chart.log_y = section.boolean("log_y");
  const ChartMaker maker(section, rows, frames_of);
  for (const auto& [label, series] : section.sections("series"))
    for (Chart::Series& one : maker.series(label, series, notes)) chart.series.push_back(std::move(one));
  for (const auto& [label, limit] : section.sections("limits"))
    if (auto one = maker.limit(label, limit, notes)) chart.limits.push_back(std::move(*one));
  return chart;
}

}  // namespace pliant
