#include "experiments/study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {

std::vector<Parameter> Measure::rows() {
  return {
      text("value").doc("a formula over the numbers of a run in result.json, as in 1000 / time_ms.total"),
      words("where").optional().doc(
          "only of the runs that have AXIS=VALUE, as in [method=ED]; Ad* takes what begins so"),
      reals("frames", 2)
          .optional()
          .doc("the first and the last: the formula is over the numbers of each frame between them that was "
               "tracked "
               "(frames.jsonl), and a run's value is their mean"),
  };
}

Measure::Measure(const Parameters& section, const std::vector<RunRow>& rows, const FramesOf& frames_of)
    : place_(section.place()),
      rows_(rows),
      frames_of_(frames_of),
      expression_(section.text("value"), place_),
      where_(section.words("where")) {
  check_conditions(where_, rows, place_);
  if (!section.has("frames")) return;
  const std::vector<double>& ends = section.reals("frames");
  if (!(ends[0] <= ends[1]))
    throw ConfigError(fmt::format("{}: 'frames' ends before it begins; expected [first, last]", place_));
  window_.emplace(ends[0], ends[1]);
}

Sample Measure::sample(const std::vector<std::string>& conditions) const {
  if (!window_) return {expression_, rows_, filter(conditions)};
  std::vector<double> values;
  for (const RunRow& row : rows_that(conditions)) {
    std::vector<double> known;
    for (const Numbers& frame : frames(row))
      if (const auto value = expression_.value(frame)) known.push_back(*value);
    if (!known.empty()) values.push_back(Sample(std::move(known)).mean());
  }
  return Sample(std::move(values));
}

std::vector<Numbers> Measure::frames(const RunRow& row) const {
  std::vector<Numbers> frames = frames_of_(row);
  if (window_)
    std::erase_if(frames, [&](const Numbers& frame) {
      return frame.at("frame") < window_->first || frame.at("frame") > window_->second;
    });
  return frames;
}

std::vector<RunRow> Measure::rows_that(const std::vector<std::string>& conditions) const {
  const RowFilter taken = filter(conditions);
  std::vector<RunRow> rows;
  std::copy_if(rows_.begin(), rows_.end(), std::back_inserter(rows),
               [&](const RunRow& row) { return taken.takes(row); });
  return rows;
}

RowFilter Measure::filter(const std::vector<std::string>& conditions) const {
  std::vector<std::string> all = where_;
  all.insert(all.end(), conditions.begin(), conditions.end());
  return {all, rows_, place_};
}

std::string Measure::missing() const {
  std::set<std::string> known;
  const auto add = [&](const Numbers& numbers) {
    for (const auto& [name, value] : numbers) known.insert(name);
  };
  for (const RunRow& row : window_ ? rows_that({}) : rows_)
    if (window_)
      for (const Numbers& frame : frames(row)) add(frame);
    else
      add(row.numbers);
  return unknown_name(expression_, known, window_ ? "frame" : "run");
}

std::string unknown_name(const Expression& expression, const std::set<std::string>& known,
                         const std::string& whose) {
  if (known.empty()) return "";
  for (const std::string& name : expression.names())
    if (known.count(name) == 0)
      return fmt::format("no {} has the number '{}'{}", whose, name,
                         suggestion(name, {known.begin(), known.end()}));
  return "";
}

std::string condition(const std::string& axis, const std::string& value) { return axis + "=" + value; }

}  // namespace pliant
