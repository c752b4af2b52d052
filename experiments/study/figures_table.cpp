#include "experiments/study/figures_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/study/measure.h"

namespace pliant {
namespace {

using Conditions = std::vector<std::string>;

ParameterTable column_table() {
  std::vector<Parameter> rows = Measure::rows();
  rows.push_back(integer("digits", 2).range(0, 9).doc("after the point"));
  rows.push_back(boolean("spread", false).doc("whether the standard deviation over the runs is told, too"));
  return ParameterTable(std::move(rows));
}

std::string cell_of(const Sample& sample, const Parameters& column) {
  if (sample.count() == 0) return "";
  const auto digits = column.integer("digits");
  const std::string mean = fmt::format("{:.{}f}", sample.mean(), digits);
  return column.boolean("spread") ? fmt::format("{} ± {:.{}f}", mean, sample.deviation(), digits) : mean;
}

/// The values that runs have together on some axes, each combination once.
std::vector<Conditions> combinations(const Conditions& axes, const std::vector<RunRow>& rows,
                                     const RowFilter& filter) {
  std::vector<Conditions> all;
  for (const RunRow& row : rows) {
    if (row.numbers.empty() || !filter.takes(row)) continue;
    Conditions values;
    for (const std::string& axis : axes)
      if (const auto value = row.on(axis)) values.push_back(condition(axis, *value));
    if (values.size() == axes.size() && std::find(all.begin(), all.end(), values) == all.end())
      all.push_back(values);
  }
  return all;
}

std::string value_of(const std::string& condition) { return condition.substr(condition.find('=') + 1); }

}  // namespace

ParameterTable figures_table() {
  return {
      text("title").doc("with the number that the table has in a paper"),
      words("rows").doc("the axes: a row for each combination of their values"),
      words("where").optional().doc("only of the runs that have AXIS=VALUE"),
      groups("columns", column_table()).at_least(1).doc("what is told, by the heading of its column"),
  };
}

Table make_figures_table(const std::string& name, const Parameters& section, const std::vector<RunRow>& rows,
                         const FramesOf& frames_of, std::vector<std::string>& notes) {
  const Conditions& axes = section.words("rows");
  for (const std::string& axis : axes) values_on(axis, rows, section.place());
  Table table{section.text("title"), axes, {}};
  const RowFilter filter(section.words("where"), rows, section.place());
  for (const Conditions& values : combinations(axes, rows, filter)) {
    table.rows.push_back({});
    for (const std::string& value : values) table.rows.back().cells.push_back(value_of(value));
  }
  for (const auto& [heading, column] : section.sections("columns")) {
    const Measure measure(column, rows, frames_of);
    if (const std::string missing = measure.missing(); !missing.empty())
      notes.push_back(fmt::format("{}: {}", name, missing));
    table.header.push_back(heading);
    std::size_t row = 0;
    for (Conditions values : combinations(axes, rows, filter)) {
      values.insert(values.end(), section.words("where").begin(), section.words("where").end());
      table.rows[row++].cells.push_back(cell_of(measure.sample(values), column));
    }
  }
  return table;
}

}  // namespace pliant
