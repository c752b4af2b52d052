#include "framework/core/parameters.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace pliant {

Parameter&& Parameter::unit(std::string unit) && {
  unit_ = std::move(unit);
  return std::move(*this);
}

Parameter&& Parameter::doc(std::string doc) && {
  doc_ = std::move(doc);
  return std::move(*this);
}

Parameter&& Parameter::range(double lowest, double highest) && {
  lowest_ = lowest;
  highest_ = highest;
  return std::move(*this);
}

Parameter&& Parameter::at_least(double lowest) && {
  lowest_ = lowest;
  return std::move(*this);
}

Parameter&& Parameter::above(double lowest) && {
  lowest_ = lowest;
  lowest_excluded_ = true;
  return std::move(*this);
}

Parameter&& Parameter::multiple_of(std::int64_t step) && {
  step_ = step;
  return std::move(*this);
}

Parameter&& Parameter::optional() && {
  optional_ = true;
  return std::move(*this);
}

Parameter&& Parameter::by_default(std::vector<std::string> names) && {
  default_names_ = std::move(names);
  return std::move(*this);
}

Parameter&& Parameter::swept_by(std::string key) && {
  swept_by_ = std::move(key);
  return std::move(*this);
}

const Parameter* ParameterTable::find(const std::string& name) const {
  const auto row = std::find_if(rows_.begin(), rows_.end(),
                                [&](const Parameter& candidate) { return candidate.name() == name; });
  return row == rows_.end() ? nullptr : &*row;
}

bool holds_overrides(const Parameter& row) {
  if (row.type() == ParameterType::overrides) return true;
  if (row.type() != ParameterType::group) return false;
  const auto& rows = row.table().rows();
  return std::any_of(rows.begin(), rows.end(), holds_overrides);
}

Parameter boolean(std::string name, std::optional<bool> fallback) {
  Parameter row(std::move(name), ParameterType::boolean);
  if (fallback) row.default_ = *fallback ? "true" : "false";
  return row;
}

Parameter integer(std::string name, std::optional<std::int64_t> fallback) {
  Parameter row(std::move(name), ParameterType::integer);
  if (fallback) row.default_ = fmt::format("{}", *fallback);
  return row;
}

Parameter real(std::string name, std::optional<double> fallback) {
  Parameter row(std::move(name), ParameterType::real);
  if (fallback) row.default_ = fmt::format("{}", *fallback);
  return row;
}

Parameter text(std::string name, std::optional<std::string> fallback) {
  Parameter row(std::move(name), ParameterType::text);
  row.default_ = std::move(fallback);
  return row;
}

Parameter choice(std::string name, std::vector<std::string> choices, std::optional<std::string> fallback) {
  Parameter row(std::move(name), ParameterType::choice);
  row.choices_ = std::move(choices);
  row.default_ = std::move(fallback);
  return row;
}

Parameter path(std::string name) { return {std::move(name), ParameterType::path}; }

Parameter component(std::string name, std::string kind, std::optional<std::string> fallback) {
  Parameter row(std::move(name), ParameterType::component);
  row.kind_ = std::move(kind);
  row.default_ = std::move(fallback);
  return row;
}

Parameter components(std::string name, std::string kind) {
  Parameter row(std::move(name), ParameterType::components);
  row.kind_ = std::move(kind);
  return row;
}

Parameter group(std::string name, ParameterTable table) {
  Parameter row(std::move(name), ParameterType::group);
  row.table_ = std::make_shared<const ParameterTable>(std::move(table));
  row.default_ = "";
  return row;
}

Parameter groups(std::string name, ParameterTable table) {
  if (std::any_of(table.rows().begin(), table.rows().end(), holds_overrides))
    throw std::logic_error("the entries of '" + name + "' hold overrides");
  Parameter row(std::move(name), ParameterType::groups);
  row.table_ = std::make_shared<const ParameterTable>(std::move(table));
  return row;
}

Parameter overrides(std::string name) {
  Parameter row(std::move(name), ParameterType::overrides);
  row.default_ = "";
  return row;
}

Parameter words(std::string name) { return {std::move(name), ParameterType::words}; }

Parameter reals(std::string name, std::size_t size, std::optional<std::vector<double>> fallback) {
  Parameter row(std::move(name), ParameterType::reals);
  row.size_ = size;
  if (fallback) row.default_ = fmt::format("[{}]", fmt::join(*fallback, ", "));
  return row;
}

namespace {

template <class T>
const T& value_as(const Parameters::Value& value, const char* type) {
  const T* held = std::get_if<T>(&value.value);
  if (held == nullptr) throw std::logic_error("parameter '" + value.name + "' does not hold " + type);
  return *held;
}

}  // namespace

const Parameters::Value& Parameters::at(const std::string& name) const {
  for (const auto& value : values_) {
    if (value.name == name) return value;
  }
  throw std::logic_error("no parameter '" + name + "' in the section of '" + component_ + "'");
}

bool Parameters::has(const std::string& name) const {
  return std::any_of(values_.begin(), values_.end(), [&](const Value& value) { return value.name == name; });
}

bool Parameters::boolean(const std::string& name) const { return value_as<bool>(at(name), "a boolean"); }

std::int64_t Parameters::integer(const std::string& name) const {
  return value_as<std::int64_t>(at(name), "an integer");
}

double Parameters::real(const std::string& name) const { return value_as<double>(at(name), "a real number"); }

const std::string& Parameters::text(const std::string& name) const {
  return value_as<std::string>(at(name), "a text");
}

const std::vector<std::string>& Parameters::words(const std::string& name) const {
  return value_as<std::vector<std::string>>(at(name), "words");
}

const std::vector<double>& Parameters::reals(const std::string& name) const {
  return value_as<std::vector<double>>(at(name), "real numbers");
}

const Parameters& Parameters::section(const std::string& name) const {
  const Value& value = at(name);
  if (!value.is_section) throw std::logic_error("parameter '" + name + "' does not hold a section");
  return value_as<Sections>(value, "a section").front().second;
}

const std::vector<std::pair<std::string, Parameters>>& Parameters::sections(const std::string& name) const {
  const Value& value = at(name);
  if (value.is_section) throw std::logic_error("parameter '" + name + "' holds one section, not several");
  return value_as<Sections>(value, "sections");
}

}  // namespace pliant
