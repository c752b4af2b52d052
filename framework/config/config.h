#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "framework/core/parameters.h"
#include "framework/core/registry.h"

namespace pliant {

/// An experiment that stands in no file.
struct ConfigText {
  std::string text;              ///< in YAML, as a file would hold it
  std::string name;              ///< of the text, as errors show it in the place of a file's
  std::filesystem::path folder;  ///< where relative files start that it names, as those beside a file do
};

/// What an experiment is read from.
struct ConfigSource {
  std::variant<std::filesystem::path, ConfigText> from;  ///< a file, or a text
  /// Values laid over the file, each "a.b.c=value" with the value in YAML, e.g. "solver.type=ceres_lm". A
  /// section that names another component than the file does replaces the file's; all of them together are
  /// one overlay, so their order does not matter.
  std::vector<std::string> sets;
  /// Where files named in the experiment are looked for, in this order, after the folder of the YAML file
  /// that names them (for `sets`: after the current folder).
  std::vector<std::filesystem::path> data_folders;
  /// Where a relative file in `extends` is looked for, in this order, when it is not found beside the file
  /// that names it: the folders of methods that come with an installation.
  std::vector<std::filesystem::path> base_folders = {};
  /// What `extends` finds before any file: the texts of files by their relative paths, for programs that
  /// carry their methods with them. What such a text extends is named relative to its own path.
  std::map<std::string, std::string> base_texts = {};

  /// The path of the file or the name of the text, as errors show it.
  std::string name() const;
};

/// A checked experiment.
struct Experiment {
  /// Every key of the table, with the defaults filled in. The entries of an `overrides` parameter are whole
  /// experiments: this one with the entry laid over it, without the parameters that hold overrides.
  Parameters values;
  /// The same as a tree of typed values, with an override as the part that was given.
  nlohmann::ordered_json tree;
  /// All files that it was read from or names; absolute.
  std::vector<std::filesystem::path> files = {};

  /// The whole experiment as a file that stands alone; it loads again to the same values.
  std::string to_yaml() const;
  const nlohmann::ordered_json& to_json() const { return tree; }
};

/// Reads an experiment strictly against the table `root`. A file may name another one in its top-level key
/// `extends` (a base text, absolute, relative to itself, or else to one of the base folders), over which it
/// is laid: maps merge, the overlay wins, and a section that names another component replaces the whole
/// section. Lists under the key of an `overrides` parameter's sweeps become overrides (see
/// Parameter::swept_by), of which each is named after its values: "step=2,seed=1".
///
/// Throws one ConfigError that tells everything that is wrong, one line each:
/// `file:line:column: what is wrong; what was expected; did you mean 'x'?`
Experiment load_experiment(const ConfigSource& source, const ParameterTable& root, const Registry& registry);

}  // namespace pliant
