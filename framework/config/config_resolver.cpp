#include "framework/config/config_resolver.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "framework/config/config_overrides.h"
#include "framework/config/config_scalar.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Kind = ConfigNode::Kind;

std::vector<std::string> names_of(const ParameterTable& table) {
  std::vector<std::string> names;
  for (const auto& row : table.rows()) names.push_back(row.name());
  return names;
}

std::string one_of(const std::vector<std::string>& choices) {
  if (choices.empty()) return "none, there is nothing to choose from";
  return fmt::format("{}{}", choices.size() > 1 ? "one of " : "", fmt::join(choices, ", "));
}

/// The default of a map of components as it would stand in the file.
ConfigEntry named_by_default(const Parameter& row, const ConfigMark& mark) {
  ConfigEntry entry{row.name(), mark, {}};
  entry.value.kind = ConfigNode::Kind::map;
  for (const std::string& name : row.default_names()) entry.value.entries.push_back({name, mark, {}});
  return entry;
}

std::string expected_section(const ParameterTable& table) {
  return fmt::format("a section with keys of {}", fmt::join(names_of(table), ", "));
}

}  // namespace

ConfigResolver::ConfigResolver(const ParameterTable& root, const Registry& registry,
                               std::vector<std::filesystem::path> data_folders, ConfigErrors& errors)
    : root_(root),
      run_table_(without_overrides(root)),
      registry_(registry),
      data_folders_(std::move(data_folders)),
      errors_(errors) {}

ResolvedSection ConfigResolver::experiment(const ConfigNode& tree,
                                           const std::vector<std::string>& other_keys) {
  const auto gives_overrides = [&](const Parameter& row) {
    const ConfigEntry* entry = row.type() == ParameterType::overrides ? tree.find(row.name()) : nullptr;
    return entry != nullptr && !entry->value.entries.empty();
  };
  const auto& rows = root_.rows();
  const bool is_base_only = std::any_of(rows.begin(), rows.end(), gives_overrides);
  return section(&tree, root_, {"", tree.mark, is_base_only}, "", other_keys);
}

ResolvedSection ConfigResolver::section(const ConfigNode* node, const ParameterTable& table,
                                        const Place& place, const std::string& component,
                                        const std::vector<std::string>& other_keys) {
  ResolvedSection result;
  if (!component.empty()) result.tree["type"] = component;
  std::vector<Parameters::Value> values;
  for (const auto& row : table.rows()) {
    const ConfigEntry* entry = node == nullptr ? nullptr : node->find(row.name());
    MaybeResolved resolved = entry == nullptr ? absent(row, place) : given(row, *entry, place);
    if (!resolved) continue;
    values.push_back(std::move(resolved->value));
    if (!resolved->tree.is_null()) result.tree[row.name()] = std::move(resolved->tree);
  }
  if (node != nullptr) report_unknown_keys(*node, table, place, other_keys);
  result.values = Parameters(component, std::move(values), to_string(place.mark));
  return result;
}

void ConfigResolver::report_unknown_keys(const ConfigNode& node, const ParameterTable& table,
                                         const Place& place, const std::vector<std::string>& other_keys) {
  std::vector<std::string> keys = names_of(table);
  keys.insert(keys.end(), other_keys.begin(), other_keys.end());
  for (const auto& entry : node.entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::string where = place.path.empty() ? "" : " in " + in_quotes(place.path);
    errors_.add(entry.mark, fmt::format("unknown key {}{}; expected {}{}", in_quotes(entry.key), where,
                                        one_of(keys), suggestion(entry.key, keys)));
  }
}

ConfigResolver::MaybeResolved ConfigResolver::absent(const Parameter& row, const Place& place) {
  if (!row.default_names().empty()) return components(row, named_by_default(row, place.mark), place);
  const ParameterType type = row.type();
  const bool is_list =
      type == ParameterType::components || type == ParameterType::groups || type == ParameterType::words;
  if (type == ParameterType::overrides || (is_list && row.is_optional())) {
    if (type == ParameterType::words)
      return Resolved{{row.name(), std::vector<std::string>{}}, ordered_json::array()};
    // Left out when it is written again where an empty map would be an error.
    return Resolved{{row.name(), Parameters::Sections{}},
                    row.lowest() ? ordered_json() : ordered_json::object()};
  }
  if (row.is_optional()) return {};
  if (!row.default_text() && place.is_base_only) return {};
  if (!row.default_text()) {
    errors_.add(place.mark,
                fmt::format("missing key {}; expected {}", in_quotes(place.key(row.name())), expected(row)));
    return {};
  }
  const Place below{place.key(row.name()), place.mark};
  if (type == ParameterType::group || type == ParameterType::component) {
    std::optional<ResolvedSection> resolved;
    if (type == ParameterType::group)
      resolved = section(nullptr, row.table(), below, "", {});
    else
      resolved = named_component(row.kind(), *row.default_text(), nullptr, below, place.mark);
    if (!resolved) return {};
    return Resolved{{row.name(), Parameters::Sections{{row.name(), resolved->values}}, true}, resolved->tree};
  }
  const ordered_json value = typed_default(row);
  return Resolved{typed_value(row.name(), value), value};
}

ConfigResolver::MaybeResolved ConfigResolver::given(const Parameter& row, const ConfigEntry& entry,
                                                    const Place& place) {
  const Place below{place.key(row.name()), entry.mark};
  std::optional<ResolvedSection> resolved;
  switch (row.type()) {
    case ParameterType::path:
      return file(row, entry, place);
    case ParameterType::words:
      return words(row, entry, place);
    case ParameterType::reals:
      return reals(row, entry, place);
    case ParameterType::components:
      return components(row, entry, place);
    case ParameterType::groups:
      return groups(row, entry, place);
    case ParameterType::overrides:
      return runs(row, entry);
    case ParameterType::group:
      if (entry.value.kind != Kind::map) {
        report(row, entry, place);
        return {};
      }
      resolved = section(&entry.value, row.table(), below, "", {});
      break;
    case ParameterType::component:
      if (entry.value.kind != Kind::map && entry.value.kind != Kind::scalar) {
        report(row, entry, place);
        return {};
      }
      resolved = component(row.kind(), entry.value, below, row.default_text());
      break;
    default:
      return scalar(row, entry, place);
  }
  if (!resolved) return {};
  return Resolved{{row.name(), Parameters::Sections{{row.name(), resolved->values}}, true}, resolved->tree};
}

ConfigResolver::MaybeResolved ConfigResolver::components(const Parameter& row, const ConfigEntry& entry,
                                                         const Place& place) {
  if (!is_map_of_enough(row, entry, place)) return {};
  Parameters::Sections sections;
  ordered_json tree = ordered_json::object();
  for (const auto& labelled : entry.value.entries) {
    const Place below{place.key(row.name()) + "." + labelled.key, labelled.mark};
    auto resolved = component(row.kind(), labelled.value, below, labelled.key);
    if (!resolved) continue;
    sections.emplace_back(labelled.key, std::move(resolved->values));
    tree[labelled.key] = std::move(resolved->tree);
  }
  return Resolved{{row.name(), std::move(sections)}, std::move(tree)};
}

ConfigResolver::MaybeResolved ConfigResolver::groups(const Parameter& row, const ConfigEntry& entry,
                                                     const Place& place) {
  if (!is_map_of_enough(row, entry, place)) return {};
  Parameters::Sections sections;
  ordered_json tree = ordered_json::object();
  for (const auto& labelled : entry.value.entries) {
    const Place below{place.key(row.name()) + "." + labelled.key, labelled.mark};
    if (labelled.value.kind != Kind::map && labelled.value.kind != Kind::null) {
      errors_.add_unexpected(labelled, below.path, expected_section(row.table()));
      continue;
    }
    auto resolved = section(&labelled.value, row.table(), below, "", {});
    sections.emplace_back(labelled.key, std::move(resolved.values));
    tree[labelled.key] = std::move(resolved.tree);
  }
  return Resolved{{row.name(), std::move(sections)}, std::move(tree)};
}

/// Reports what is no map, and a map of too few entries.
bool ConfigResolver::is_map_of_enough(const Parameter& row, const ConfigEntry& entry, const Place& place) {
  const std::size_t count = entry.value.entries.size();
  if (entry.value.kind != Kind::map)
    report(row, entry, place);
  else if (row.lowest() && static_cast<double>(count) < *row.lowest())
    errors_.add(entry.mark, fmt::format("{} has {} entries; expected at least {}",
                                        in_quotes(place.key(row.name())), count, *row.lowest()));
  else
    return true;
  return false;
}

ConfigResolver::MaybeResolved ConfigResolver::runs(const Parameter& row, const ConfigEntry& entry) {
  Parameters::Sections sections;
  ordered_json tree = ordered_json::object();
  for (const auto& run : entry.value.entries) {
    ResolvedSection resolved = section(&run.value, run_table_, {"", run.value.mark}, "", {});
    tree[run.key] = std::move(resolved.tree);
    sections.emplace_back(run.key, Parameters("", resolved.values.values(), to_string(run.mark)));
  }
  return Resolved{{row.name(), std::move(sections)}, std::move(tree)};
}

std::optional<ResolvedSection> ConfigResolver::component(const std::string& kind, const ConfigNode& node,
                                                         const Place& place,
                                                         const std::optional<std::string>& implied) {
  if (node.kind == Kind::scalar) return named_component(kind, node.text, nullptr, place, node.mark);
  if (node.kind == Kind::list) {
    errors_.add(node.mark,
                fmt::format("{} is a list; expected {}", in_quotes(place.path), expected_component(kind)));
    return {};
  }
  const ConfigEntry* type = node.find("type");
  if (type == nullptr && implied) return named_component(kind, *implied, &node, place, place.mark);
  if (type == nullptr) {
    errors_.add(place.mark, fmt::format("missing key {}; expected {}", in_quotes(place.key("type")),
                                        expected_component(kind)));
    return {};
  }
  if (type->value.kind != Kind::scalar) {
    errors_.add(type->mark, fmt::format("{} is {}; expected {}", in_quotes(place.key("type")),
                                        shown(type->value), expected_component(kind)));
    return {};
  }
  return named_component(kind, type->value.text, &node, place, type->value.mark);
}

std::optional<ResolvedSection> ConfigResolver::named_component(const std::string& kind,
                                                               const std::string& name,
                                                               const ConfigNode* node, const Place& place,
                                                               const ConfigMark& name_mark) {
  if (const ComponentInfo* info = registry_.find(kind, name))
    return section(node, info->parameters, place, name, {"type"});
  std::vector<std::string> names;
  for (const auto* info : registry_.components(kind)) names.push_back(info->name);
  errors_.add(name_mark, fmt::format("unknown {} {} for {}; expected {}{}", kind, in_quotes(name),
                                     in_quotes(place.path), one_of(names), suggestion(name, names)));
  return {};
}

void ConfigResolver::report(const Parameter& row, const ConfigEntry& entry, const Place& place,
                            const std::string& hint) {
  errors_.add_unexpected(entry, place.key(row.name()), expected(row) + hint);
}

std::string ConfigResolver::expected(const Parameter& row) const {
  const std::string range = range_text(row);
  const std::string limits =
      (range.empty() ? "" : " " + range) + (row.unit().empty() ? "" : " (" + row.unit() + ")");
  switch (row.type()) {
    case ParameterType::boolean:
      return "true or false";
    case ParameterType::integer:
      return "an integer" + limits;
    case ParameterType::real:
      return "a finite number" + limits;
    case ParameterType::text:
      return "a text";
    case ParameterType::choice:
      return one_of(row.choices());
    case ParameterType::path:
      return "the path of a file";
    case ParameterType::component:
      return expected_component(row.kind());
    case ParameterType::components:
      return "a section of labels, each for " + expected_component(row.kind());
    case ParameterType::group:
      return expected_section(row.table());
    case ParameterType::groups:
      return "a map from names, each to " + expected_section(row.table());
    case ParameterType::overrides:
      return expected_overrides;
    case ParameterType::words:
      return "a list of texts";
    case ParameterType::reals:
      return fmt::format("a list of {} finite numbers", row.size()) + limits;
  }
  throw std::logic_error("a parameter type without a name");
}

std::string ConfigResolver::expected_component(const std::string& kind) const {
  std::vector<std::string> names;
  for (const auto* info : registry_.components(kind)) names.push_back(info->name);
  return fmt::format("a component of kind {} ({})", kind, fmt::join(names, ", "));
}

}  // namespace pliant
