#include "experiments/tasks/json_file.h"

#include <fmt/format.h>

#include <cmath>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

void check_finite(const ordered_json& json, const std::string& key) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw NumericalError(fmt::format("{} is {}; there is no finite answer", key, json.get<double>()));
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) check_finite(value, key.empty() ? name : key + "." + name);
  }
  if (json.is_array()) {
    for (std::size_t i = 0; i < json.size(); ++i) check_finite(json[i], fmt::format("{}[{}]", key, i));
  }
}

/// In one line where `indent` is below 0.
std::string checked_text(const ordered_json& json, int indent) {
  check_finite(json, "");
  return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

ordered_json parse(const std::string& text, const std::string& place) {
  ordered_json json = ordered_json::parse(text, nullptr, false);
  if (json.is_discarded()) throw DataError(place + ": is no JSON");
  return json;
}

}  // namespace

void write_json(const std::string& path, const ordered_json& json) {
  const std::string text = checked_text(json, 2);
  write_file(path, {text.begin(), text.end()});
}

ordered_json read_json(const std::string& path) {
  const auto bytes = read_file(path);
  return parse({bytes.begin(), bytes.end()}, path);
}

void JsonLines::append(const ordered_json& json) { lines_.append(checked_text(json, -1)); }

std::vector<ordered_json> read_json_lines(const std::string& path) {
  std::vector<ordered_json> values;
  for (const std::string& line : read_whole_lines(path))
    values.push_back(parse(line, fmt::format("{}:{}", path, values.size() + 1)));
  return values;
}

}  // namespace pliant
