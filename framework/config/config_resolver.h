#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

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

  /// The experiment's overrides must be whole experiments already (see complete_overrides). `other_keys` are
  /// those of a file that have been dealt with before.
  ResolvedSection experiment(const ConfigNode& tree, const std::vector<std::string>& other_keys);

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
    /// Of an experiment that has overrides: what it lacks each of them must give.
    bool is_base_only = false;
    std::string key(const std::string& name) const { return path.empty() ? name : path + "." + name; }
  };

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
  MaybeResolved groups(const Parameter& row, const ConfigEntry& entry, const Place& place);
  bool is_map_of_enough(const Parameter& row, const ConfigEntry& entry, const Place& place);
  MaybeResolved runs(const Parameter& row, const ConfigEntry& entry);
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
  const ParameterTable run_table_;  ///< of an experiment that is an override of another
  const Registry& registry_;
  std::vector<std::filesystem::path> data_folders_;
  ConfigErrors& errors_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace pliant
