#include "experiments/study/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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
  return {expression_, rows_, filter(conditions)};
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
  for (const RunRow& row : rows_)
    for (const auto& [name, value] : row.numbers) known.insert(name);
  return unknown_name(expression_, known, "run");
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
