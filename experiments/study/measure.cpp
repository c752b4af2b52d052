#include "experiments/study/measure.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/core/nearest.h"

namespace pliant {

std::vector<Parameter> Measure::rows() {
  return {
      text("value").doc("a formula over the numbers of a run in result.json, as in 1000 / time_ms.total"),
      words("where").optional().doc(
          "only of the runs that have AXIS=VALUE, as in [method=ED]; Ad* takes what begins so"),
  };
}

Measure::Measure(const Parameters& section, const std::vector<RunRow>& rows)
    : place_(section.place()),
      rows_(rows),
      expression_(section.text("value"), place_),
      where_(section.words("where")) {
  check_conditions(where_, rows, place_);
}

Sample Measure::sample(const std::vector<std::string>& conditions) const {
  std::vector<std::string> all = where_;
  all.insert(all.end(), conditions.begin(), conditions.end());
  return {expression_, rows_, RowFilter(all, rows_, place_)};
}

std::string Measure::missing() const {
  std::vector<std::string> known;
  for (const RunRow& row : rows_)
    for (const auto& [name, value] : row.numbers)
      if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  if (known.empty()) return "";
  for (const std::string& name : expression_.names())
    if (std::find(known.begin(), known.end(), name) == known.end())
      return fmt::format("no run has the number '{}'{}", name, suggestion(name, known));
  return "";
}

std::string condition(const std::string& axis, const std::string& value) { return axis + "=" + value; }

}  // namespace pliant
