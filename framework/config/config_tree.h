#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/error.h"

namespace pliant {

/// What a value was read from: an experiment's file or text, or a `--set` of the command line.
struct ConfigOrigin {
  std::string name;              ///< as errors show it: the file's path, or "--set a.b"
  std::filesystem::path folder;  ///< where the relative paths that it names start
  bool has_lines = true;
  int order = 0;                            ///< errors are listed in this order of their origins
  std::filesystem::path shown_folder = {};  ///< the folder as errors show it
};

/// A place in an origin, counted from 1; line 0 means the origin as a whole.
struct ConfigMark {
  std::shared_ptr<const ConfigOrigin> origin;
  int line = 0;
  int column = 0;
};

/// "file:line:column", or what the origin is called where there is no more to say.
std::string to_string(const ConfigMark& mark);

struct ConfigEntry;

/// One value of an experiment file that remembers where it was given.
struct ConfigNode {
  enum class Kind { null, scalar, list, map };

  const ConfigEntry* find(const std::string& key) const;
  ConfigEntry* find(const std::string& key);
  /// Removes the entry from the map and returns it; empty where there is none.
  std::optional<ConfigEntry> take(const std::string& key);

  Kind kind = Kind::null;
  ConfigMark mark;
  std::string text;     ///< of a scalar
  bool quoted = false;  ///< a scalar that can only be a text
  std::vector<ConfigNode> items;
  std::vector<ConfigEntry> entries;  ///< of a map: in file order, every key once
};

struct ConfigEntry {
  std::string key;
  ConfigMark mark;  ///< of the key
  ConfigNode value;
};

/// The keys of "a.b.c"; empty when one of them is.
std::vector<std::string> split_keys(const std::string& path);

/// The sections that lead to `value` by these keys, all of them given at `mark`: {a: {b: value}}.
ConfigNode under_keys(const std::vector<std::string>& keys, const ConfigMark& mark, ConfigNode value);

/// How many values a node holds, itself included.
std::size_t count_nodes(const ConfigNode& node);

/// A scalar as errors show it: in quotes, on one line, and cut where it is long.
std::string in_quotes(const std::string& text);

/// What a value is, as errors show it: "empty", "a list", "a section", or the scalar itself.
std::string shown(const ConfigNode& node);

/// Collects the errors of an experiment so that all of them can be reported at once.
class ConfigErrors {
 public:
  /// An error that is word for word an earlier one is dropped.
  void add(const ConfigMark& mark, const std::string& message);

  /// "'path' is ...; expected ...", at the value where that is a scalar, else at its key.
  void add_unexpected(const ConfigEntry& entry, const std::string& path, const std::string& expected);

  bool empty() const { return errors_.empty(); }

  /// Throws one ConfigError with a line per error, in the order of their places, if there are any.
  void throw_if_any() const;

 private:
  struct Item {
    ConfigMark mark;
    std::string line;
  };
  std::vector<Item> errors_;
  std::size_t dropped_ = 0;
};

}  // namespace pliant
