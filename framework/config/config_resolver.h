#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "framework/config/config_overlay.h"
#include "framework/config/config_tree.h"
#include "framework/core/registry.h"

namespace pliant {

/// A checked section: its values, and the same as it is written out again.
struct ResolvedSection {
  Parameters values;
  nlohmann::ordered_json tree = nlohmann::ordered_json::object();
};

/// Checks an experiment against the tables and fills in the defaults. Everything that is wrong goes to the
/// list of errors; where that is not empty afterwards, the result is of no use.
class ConfigResolver {
 public:
  ConfigResolver(const ParameterTable& root, const Registry& registry,
                 std::vector<std::filesystem::path> data_folders, ConfigErrors& errors);

  ResolvedSection experiment(const ConfigNode& tree);

  /// The files that the experiment names, absolute.
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  /// What a row's key was resolved to; empty after an error, and for an optional key that is not there. A
  /// null `tree` is not written.
  struct Resolved {
    Parameters::Value value;
    nlohmann::ordered_json tree;
  };
  using MaybeResolved = std::optional<Resolved>;
  struct Place {
    std::string path;  ///< dotted name of the section, empty for the experiment
    ConfigMark mark;   ///< where the section is named
    std::string key(const std::string& name) const { return path.empty() ? name : path + "." + name; }
  };

  bool is_visible(const Parameter& row) const;
  std::vector<std::string> visible_keys(const ParameterTable& table) const;
  ResolvedSection section(const ConfigNode* node, const ParameterTable& table, const Place& place,
                          const std::string& component, const std::vector<std::string>& other_keys);
  void report_unknown_keys(const ConfigNode& node, const ParameterTable& table, const Place& place,
                           const std::vector<std::string>& other_keys);
  MaybeResolved absent(const Parameter& row, const Place& place);
  MaybeResolved given(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved scalar(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved file(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved words(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved reals(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved components(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved overrides(const Parameter& row, const ConfigEntry& entry, const Place& place);
  ConfigNode without_overrides() const;
  std::optional<ResolvedSection> component(const std::string& kind, const ConfigNode& node,
                                           const Place& place, const std::optional<std::string>& implied);
  std::optional<ResolvedSection> named_component(const std::string& kind, const std::string& name,
                                                 const ConfigNode* node, const Place& place,
                                                 const ConfigMark& name_mark);
  void report(const Parameter& row, const ConfigEntry& entry, const Place& place,
              const std::string& hint = "");
  std::string expected(const Parameter& row) const;
  std::string expected_component(const std::string& kind) const;

  const ParameterTable& root_;
  const Registry& registry_;
  std::vector<std::filesystem::path> data_folders_;
  ConfigErrors& errors_;
  std::vector<std::filesystem::path> files_;
  const ConfigNode* experiment_ = nullptr;
  bool inside_override_ = false;
};

/// Whether the row is, or somewhere in its group has, a map of overrides.
bool holds_overrides(const Parameter& row);

/// The allowed values in words, e.g. "from 1 to 64", "above 0"; empty where every value is allowed.
std::string range_text(const Parameter& row);

/// The default of a scalar row with its type; null where it has none.
nlohmann::ordered_json typed_default(const Parameter& row);

}  // namespace pliant
