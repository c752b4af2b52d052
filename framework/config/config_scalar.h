#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "framework/core/parameters.h"

namespace pliant {

/// The scalar that `text` is for this row, or null when it is none or out of range.
nlohmann::ordered_json typed_scalar(const Parameter& row, const std::string& text);

/// The finite number that the whole of `text` spells out, if the row's range allows it.
std::optional<double> number_in_range(const Parameter& row, const std::string& text);

/// A scalar or a list of numbers as the value of the parameter `name`.
Parameters::Value typed_value(const std::string& name, const nlohmann::ordered_json& scalar);

/// The default of a scalar row with its type; null where it has none.
nlohmann::ordered_json typed_default(const Parameter& row);

/// The allowed values in words, e.g. "from 1 to 64", "above 0"; empty where every value is allowed.
std::string range_text(const Parameter& row);

/// "; did you mean 'true'?" for the words that YAML 1.1 takes for booleans; else empty.
std::string boolean_hint(std::string text);

}  // namespace pliant
