#include "framework/config/config_scalar.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>

namespace pliant {
namespace {

using nlohmann::ordered_json;

/// The finite number that the whole of `text` spells out.
template <class Number>
std::optional<Number> parse_number(const std::string& text) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  // What from_chars takes beside digits ("inf", "-nan", and "-" after the "+" above) is no number here.
  const char* digits = first != last && *first == '-' && first == text.data() ? first + 1 : first;
  if (digits == last || !(std::isdigit(static_cast<unsigned char>(*digits)) != 0 || *digits == '.'))
    return {};
  Number number{};
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last) return {};
  return number;
}

std::optional<bool> parse_boolean(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return {};
}

bool in_range(const Parameter& row, double value) {
  if (row.lowest() && (row.lowest_excluded() ? value <= *row.lowest() : value < *row.lowest())) return false;
  return !row.highest() || value <= *row.highest();
}

std::string limits_text(const Parameter& row) {
  const std::string highest = row.highest() ? fmt::format("{}", *row.highest()) : "";
  if (!row.lowest()) return highest.empty() ? "" : "at most " + highest;
  if (row.lowest_excluded())
    return fmt::format("above {}{}{}", *row.lowest(), highest.empty() ? "" : " and at most ", highest);
  if (highest.empty()) return fmt::format("at least {}", *row.lowest());
  return fmt::format("from {} to {}", *row.lowest(), highest);
}

}  // namespace

ordered_json typed_scalar(const Parameter& row, const std::string& text) {
  if (row.type() == ParameterType::boolean) {
    if (const auto value = parse_boolean(text)) return *value;
    return nullptr;
  }
  if (row.type() == ParameterType::integer) {
    const auto value = parse_number<std::int64_t>(text);
    if (value && in_range(row, static_cast<double>(*value)) && *value % row.step() == 0) return *value;
    return nullptr;
  }
  if (row.type() == ParameterType::real) {
    if (const auto value = number_in_range(row, text)) return *value;
    return nullptr;
  }
  if (row.type() == ParameterType::choice) {
    const auto& choices = row.choices();
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) return nullptr;
  }
  return text;
}

std::optional<double> number_in_range(const Parameter& row, const std::string& text) {
  const auto number = parse_number<double>(text);
  return number && in_range(row, *number) ? number : std::nullopt;
}

Parameters::Value typed_value(const std::string& name, const ordered_json& scalar) {
  if (scalar.is_boolean()) return {name, scalar.get<bool>()};
  if (scalar.is_number_integer()) return {name, scalar.get<std::int64_t>()};
  if (scalar.is_number_float()) return {name, scalar.get<double>()};
  if (scalar.is_array()) return {name, scalar.get<std::vector<double>>()};
  return {name, scalar.get<std::string>()};
}

ordered_json typed_default(const Parameter& row) {
  if (!row.default_text()) return nullptr;
  if (row.type() == ParameterType::reals)
    return ordered_json::parse(*row.default_text()).get<std::vector<double>>();
  ordered_json value = typed_scalar(row, *row.default_text());
  if (value.is_null())
    throw std::logic_error("the default of parameter '" + row.name() + "' is not allowed by its own row");
  return value;
}

std::string range_text(const Parameter& row) {
  std::string limits = limits_text(row);
  if (row.step() == 1) return limits;
  return fmt::format("{}{}a multiple of {}", limits, limits.empty() ? "" : ", ", row.step());
}

std::string boolean_hint(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* word : {"yes", "y", "on", "true", "1"})
    if (text == word) return "; did you mean 'true'?";
  for (const char* word : {"no", "n", "off", "false", "0"})
    if (text == word) return "; did you mean 'false'?";
  return "";
}

}  // namespace pliant
