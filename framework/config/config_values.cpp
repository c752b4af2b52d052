// What ConfigResolver makes of values that are no sections.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <system_error>

#include "framework/config/config_resolver.h"
#include "framework/config/config_scalar.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Kind = ConfigNode::Kind;

bool takes_quotes(ParameterType type) { return type == ParameterType::text || type == ParameterType::choice; }

}  // namespace

ConfigResolver::MaybeResolved ConfigResolver::scalar(const Parameter& row, const ConfigEntry& entry,
                                                     const Place& place) {
  const ConfigNode& node = entry.value;
  ordered_json value;
  if (node.kind == Kind::scalar && (!node.quoted || takes_quotes(row.type())))
    value = typed_scalar(row, node.text);
  if (!value.is_null()) return Resolved{typed_value(row.name(), value), value};
  std::string hint;
  if (node.kind == Kind::scalar && row.type() == ParameterType::boolean) hint = boolean_hint(node.text);
  if (node.kind == Kind::scalar && row.type() == ParameterType::choice)
    hint = suggestion(node.text, row.choices());
  report(row, entry, place, hint);
  return {};
}

ConfigResolver::MaybeResolved ConfigResolver::file(const Parameter& row, const ConfigEntry& entry,
                                                   const Place& place) {
  namespace fs = std::filesystem;
  const ConfigNode& node = entry.value;
  if (node.kind != Kind::scalar || node.text.empty() || node.text.find('\0') != std::string::npos) {
    report(row, entry, place);
    return {};
  }
  std::vector<fs::path> tried{node.mark.origin->folder / node.text};
  if (fs::path(node.text).is_relative()) {
    for (const auto& folder : data_folders_) tried.push_back(folder / node.text);
  }
  std::vector<std::string> looked;
  for (const auto& candidate : tried) {
    std::error_code error;
    const std::string absolute = fs::absolute(candidate).lexically_normal().string();
    if (fs::exists(absolute, error)) {
      files_.emplace_back(absolute);
      return Resolved{{row.name(), absolute}, absolute};
    }
    looked.push_back(absolute);
  }
  errors_.add(node.mark,
              fmt::format("{} names the file {}, which does not exist; looked for {}",
                          in_quotes(place.key(row.name())), in_quotes(node.text), fmt::join(looked, ", ")));
  return {};
}

ConfigResolver::MaybeResolved ConfigResolver::words(const Parameter& row, const ConfigEntry& entry,
                                                    const Place& place) {
  const ConfigNode& node = entry.value;
  if (node.kind == Kind::scalar)
    return Resolved{{row.name(), std::vector<std::string>{node.text}}, ordered_json::array({node.text})};
  if (node.kind != Kind::list) {
    report(row, entry, place);
    return {};
  }
  std::vector<std::string> texts;
  bool is_good = true;
  for (const auto& item : node.items) {
    texts.push_back(item.text);
    if (item.kind == Kind::scalar) continue;
    is_good = false;
    errors_.add(item.mark, fmt::format("an item of {} is {}; expected a text",
                                       in_quotes(place.key(row.name())), shown(item)));
  }
  if (!is_good) return {};
  return Resolved{{row.name(), texts}, texts};
}

ConfigResolver::MaybeResolved ConfigResolver::reals(const Parameter& row, const ConfigEntry& entry,
                                                    const Place& place) {
  const ConfigNode& node = entry.value;
  if (node.kind != Kind::list) {
    report(row, entry, place);
    return {};
  }
  if (node.items.size() != row.size()) {
    errors_.add(node.mark, fmt::format("{} has {} items; expected {}", in_quotes(place.key(row.name())),
                                       node.items.size(), expected(row)));
    return {};
  }
  std::vector<double> numbers;
  for (const auto& item : node.items) {
    const auto number =
        item.kind == Kind::scalar && !item.quoted ? number_in_range(row, item.text) : std::nullopt;
    if (number)
      numbers.push_back(*number);
    else
      errors_.add(item.mark, fmt::format("an item of {} is {}; expected {}", in_quotes(place.key(row.name())),
                                         shown(item), expected(row)));
  }
  if (numbers.size() != row.size()) return {};
  return Resolved{{row.name(), numbers}, numbers};
}

}  // namespace pliant
