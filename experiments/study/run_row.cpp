#include "experiments/study/run_row.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

enum class Truths { left_out, taken };

void add_numbers(const ordered_json& json, const std::string& path, Truths truths, Numbers& numbers) {
  if (json.is_number()) numbers[path] = json.get<double>();
  if (json.is_boolean() && truths == Truths::taken) numbers[path] = json.get<bool>() ? 1 : 0;
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items())
    add_numbers(value, path.empty() ? key : path + "." + key, truths, numbers);
}

/// Whether a value is the wanted one, whose last letter may be "*" for any end.
bool is_wanted(const std::string& value, const std::string& wanted) {
  if (wanted.empty() || wanted.back() != '*') return value == wanted;
  return value.starts_with(wanted.substr(0, wanted.size() - 1));
}

}  // namespace

std::vector<std::string> axes_of(const std::vector<RunRow>& rows) {
  std::vector<std::string> axes;
  for (const RunRow& row : rows)
    for (const SweptValue& value : row.axes)
      if (std::find(axes.begin(), axes.end(), value.name) == axes.end()) axes.push_back(value.name);
  return axes;
}

std::optional<std::string> RunRow::on(const std::string& axis) const {
  for (const SweptValue& value : axes)
    if (value.name == axis) return value.value;
  return std::nullopt;
}

RunRow make_run_row(const std::string& name, const ordered_json& json) {
  RunRow row{name, swept_values(name), {}};
  for (SweptValue& value : row.axes)
    if (value.name.empty()) value.name = runs_axis;
  add_numbers(json, "", Truths::left_out, row.numbers);
  return row;
}

Numbers numbers_of_frame(const ordered_json& json) {
  Numbers numbers;
  add_numbers(json, "", Truths::taken, numbers);
  return numbers;
}

RowFilter::RowFilter(const std::vector<std::string>& conditions, const std::vector<RunRow>& rows,
                     const std::string& place) {
  for (const std::string& condition : conditions) {
    const std::size_t equals = condition.find('=');
    if (equals == std::string::npos)
      throw ConfigError(
          fmt::format("{}: '{}' in 'where'; expected AXIS=VALUE, as in method=ED", place, condition));
    const SweptValue wanted{condition.substr(0, equals), condition.substr(equals + 1)};
    const auto values = values_on(wanted.name, rows, place);
    if (std::none_of(values.begin(), values.end(),
                     [&](const auto& value) { return is_wanted(value, wanted.value); }))
      throw ConfigError(fmt::format("{}: no run has '{}'; expected one of {}{}", place, condition,
                                    fmt::join(values, ", "), suggestion(wanted.value, values)));
    conditions_.push_back(wanted);
  }
}

bool RowFilter::takes(const RunRow& row) const {
  return std::all_of(conditions_.begin(), conditions_.end(), [&](const SweptValue& wanted) {
    const auto value = row.on(wanted.name);
    return value && is_wanted(*value, wanted.value);
  });
}

void check_conditions(const std::vector<std::string>& conditions, const std::vector<RunRow>& rows,
                      const std::string& place) {
  const RowFilter filter(conditions, rows, place);
}

std::vector<std::string> values_on(const std::string& axis, const std::vector<RunRow>& rows,
                                   const std::string& place) {
  std::vector<std::string> values;
  for (const RunRow& row : rows) {
    const auto value = row.on(axis);
    if (value && std::find(values.begin(), values.end(), *value) == values.end()) values.push_back(*value);
  }
  if (!values.empty()) return values;
  const auto axes = axes_of(rows);
  throw ConfigError(fmt::format("{}: the runs are not swept over '{}'; expected one of {}{}", place, axis,
                                fmt::join(axes, ", "), suggestion(axis, axes)));
}

}  // namespace pliant
