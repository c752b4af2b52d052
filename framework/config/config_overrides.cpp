#include "framework/config/config_overrides.h"

#include <vector>

#include <fmt/format.h>

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Kind = ConfigNode::Kind;

/// The experiment that every override is laid over. A key that the table does not have is left out too: it is
/// reported for the experiment itself.
ConfigNode without_overrides(const ConfigNode& experiment, const ParameterTable& root) {
  ConfigNode base;
  base.kind = Kind::map;
  base.mark = experiment.mark;
  for (const auto& entry : experiment.entries) {
    const Parameter* row = root.find(entry.key);
    if (row != nullptr && !holds_overrides(*row)) base.entries.push_back(entry);
  }
  return base;
}

class Completion {
 public:
  Completion(const ConfigNode& base, const ConfigOverlay& overlay, ConfigErrors& errors)
      : base_(base), base_size_(count_nodes(base)), overlay_(overlay), errors_(errors) {}

  /// The section with the overrides in it complete; `prefix` is its path, with a dot at the end.
  ConfigNode section(const ConfigNode& node, const ParameterTable& table, const std::string& prefix) const {
    ConfigNode complete = node;
    complete.entries.clear();
    for (const auto& entry : node.entries) {
      const Parameter* row = table.find(entry.key);
      const bool is_group = row != nullptr && row->type() == ParameterType::group;
      if (row != nullptr && row->type() == ParameterType::overrides) {
        if (is_good(entry, prefix + entry.key)) complete.entries.push_back(overrides(entry, prefix));
      } else if (is_group && entry.value.kind == Kind::map) {
        complete.entries.push_back(
            {entry.key, entry.mark, section(entry.value, row->table(), prefix + entry.key + ".")});
      } else {
        complete.entries.push_back(entry);
      }
    }
    return complete;
  }

 private:
  bool is_good(const ConfigEntry& entry, const std::string& path) const {
    const std::size_t count = entry.value.entries.size();
    if (entry.value.kind != Kind::map)
      errors_.add_unexpected(entry, path, expected_overrides);
    else if (count * base_size_ > max_override_nodes)
      errors_.add(entry.mark, fmt::format("{} has {} entries; expected fewer for an experiment of this size",
                                          in_quotes(path), count));
    else
      return true;
    return false;
  }

  ConfigEntry overrides(const ConfigEntry& entry, const std::string& prefix) const {
    ConfigEntry complete{entry.key, entry.mark, entry.value};
    complete.value.entries.clear();
    for (const auto& given : entry.value.entries) {
      if (given.value.kind != Kind::map && given.value.kind != Kind::null) {
        errors_.add(given.mark,
                    fmt::format("{} is {}; expected the keys of an experiment that differ",
                                in_quotes(prefix + entry.key + "." + given.key), shown(given.value)));
        continue;
      }
      ConfigNode whole = base_;
      // The places of the base are kept so that an error of its own is the same error here, and told once.
      overlay_.lay_over(whole, given.value, {.fragments = false, .keep_places = true});
      complete.value.entries.push_back({given.key, given.mark, std::move(whole)});
    }
    return complete;
  }

  const ConfigNode& base_;
  std::size_t base_size_;
  const ConfigOverlay& overlay_;
  ConfigErrors& errors_;
};

/// Of a resolved section, those keys that were given.
ordered_json given_part(const ordered_json& resolved, const ConfigNode& given) {
  if (!resolved.is_object()) return resolved;
  ordered_json part = ordered_json::object();
  if (given.kind == Kind::scalar) part["type"] = resolved["type"];
  for (const auto& entry : given.entries) {
    if (resolved.contains(entry.key)) part[entry.key] = given_part(resolved[entry.key], entry.value);
  }
  return part;
}

}  // namespace

ParameterTable without_overrides(const ParameterTable& root) {
  std::vector<Parameter> rows;
  for (const auto& row : root.rows()) {
    if (!holds_overrides(row)) rows.push_back(row);
  }
  return ParameterTable(std::move(rows));
}

ConfigNode complete_overrides(const ConfigNode& experiment, const ParameterTable& root,
                              const ConfigOverlay& overlay, ConfigErrors& errors) {
  const ConfigNode base = without_overrides(experiment, root);
  return Completion(base, overlay, errors).section(experiment, root, "");
}

void keep_given_overrides(ordered_json& resolved, const ConfigNode& experiment, const ParameterTable& root) {
  for (const auto& row : root.rows()) {
    const ConfigEntry* entry = experiment.find(row.name());
    if (entry == nullptr) continue;
    if (row.type() == ParameterType::group)
      keep_given_overrides(resolved[row.name()], entry->value, row.table());
    else if (row.type() == ParameterType::overrides)
      resolved[row.name()] = given_part(resolved[row.name()], entry->value);
  }
}

}  // namespace pliant
