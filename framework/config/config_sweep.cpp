#include "framework/config/config_sweep.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "framework/config/config_overrides.h"

namespace pliant {
namespace {

using Kind = ConfigNode::Kind;

// Above any sweep that somebody waits for.
constexpr std::size_t max_swept_overrides = 1000;
constexpr const char* expected_swept =
    "a list of values under a key like a.b.c, or partial experiments under names of their own";
// Below what file systems allow.
constexpr std::size_t max_name_length = 200;

using KeyPath = std::vector<std::string>;

/// A key of a sweep with the values that it takes.
struct SweptKey {
  KeyPath path;  ///< of an axis its name
  bool is_axis;  ///< whether its values are partial experiments
  ConfigMark mark;
  std::vector<ConfigNode> values;
  std::vector<std::string> value_names;
  std::string name;  ///< the shortest end of the path that no other swept key has

  /// How many values it adds to an override.
  std::size_t size() const {
    std::size_t largest = 0;
    for (const auto& value : values) largest = std::max(largest, count_nodes(value));
    return path.size() + largest;
  }
};

/// Letters of no folder's name become "_", and so do those that part keys and values from each other: by that
/// the names of different overrides differ.
std::string name_part(std::string text) {
  for (char& letter : text)
    if (letter == '=' || letter == ',' || !is_of_folder_name(letter)) letter = '_';
  return text;
}

/// What a value adds to a name; empty for a value that has no short form.
std::optional<std::string> value_name(const ConfigNode& value) {
  if (value.kind == Kind::scalar) return name_part(value.text);
  if (value.kind != Kind::list) return std::nullopt;
  std::vector<std::string> items;
  for (const auto& item : value.items) {
    if (item.kind != Kind::scalar) return std::nullopt;
    items.push_back(name_part(item.text));
  }
  return fmt::format("[{}]", fmt::join(items, ","));
}

/// The last `length` keys of a path.
KeyPath end_of(const KeyPath& path, std::size_t length) {
  return {path.end() - static_cast<std::ptrdiff_t>(std::min(length, path.size())), path.end()};
}

void name_keys(std::vector<SweptKey>& keys) {
  for (auto& key : keys) {
    std::size_t length = 1;
    const auto is_shared = [&](const SweptKey& other) {
      return other.path != key.path && end_of(other.path, length) == end_of(key.path, length);
    };
    while (length < key.path.size() && std::any_of(keys.begin(), keys.end(), is_shared)) ++length;
    key.name = name_part(fmt::format("{}", fmt::join(end_of(key.path, length), ".")));
  }
}

bool is_partial_experiment(const ConfigEntry& entry) {
  return entry.value.kind == Kind::map || entry.value.kind == Kind::null;
}

class Sweep {
 public:
  Sweep(const ConfigEntry& sweep, const ConfigOverlay& overlay, ConfigErrors& errors)
      : sweep_(sweep), overlay_(overlay), errors_(errors) {
    if (sweep.value.kind != Kind::map)
      errors.add_unexpected(sweep, sweep.key, "a section with a list of values under each key");
    for (const auto& entry : sweep.value.entries) {
      if (auto key = read(entry, in_quotes(sweep.key + "." + entry.key))) keys_.push_back(std::move(*key));
    }
    name_keys(keys_);
  }

  /// Puts the combinations in the place of the overrides `row` that the experiment has.
  void expand(ConfigNode& experiment, const Parameter& row) const {
    if (keys_.empty()) return;
    ConfigEntry overrides = find_overrides(experiment, row);
    std::vector<ConfigEntry>& entries = overrides.value.entries;
    // What is no partial experiment is reported as it stands, when overrides are made whole.
    const bool is_good = overrides.value.kind == Kind::map &&
                         std::all_of(entries.begin(), entries.end(), is_partial_experiment);
    if (!is_good) return;
    // Where there are no overrides, the experiment itself is what is swept.
    if (entries.empty()) entries.push_back({"", sweep_.mark, {}});
    if (is_too_large(entries.size(), experiment)) return;
    for (const auto& key : keys_) entries = combine(entries, key);
    check_lengths(entries);
    experiment.take(row.name());
    experiment.entries.push_back(std::move(overrides));
  }

 private:
  /// One list of values; empty where it is wrong.
  std::optional<SweptKey> read(const ConfigEntry& entry, const std::string& shown_key) const {
    if (entry.value.kind == Kind::map) return read_axis(entry, shown_key);
    SweptKey key{split_keys(entry.key), false, entry.mark, entry.value.items, {}, ""};
    if (key.path.empty()) {
      errors_.add(entry.mark, shown_key + " leads to no key; expected one like a.b.c");
      return std::nullopt;
    }
    if (entry.value.kind != Kind::list) {
      errors_.add_unexpected(entry, sweep_.key + "." + entry.key, expected_swept);
      return std::nullopt;
    }
    if (key.values.empty()) {
      errors_.add(entry.value.mark, shown_key + " is an empty list; expected at least one value");
      return std::nullopt;
    }
    std::set<std::string> known;
    for (const auto& value : key.values) {
      const auto name = value_name(value);
      if (!name) {
        errors_.add(value.mark, fmt::format("a value of {} is {}; expected a scalar or a list of scalars",
                                            shown_key, shown(value)));
        return std::nullopt;
      }
      if (!known.insert(*name).second) {
        errors_.add(value.mark, same_name(shown_key, *name));
        return std::nullopt;
      }
      key.value_names.push_back(*name);
    }
    return key;
  }

  /// Named partial experiments.
  std::optional<SweptKey> read_axis(const ConfigEntry& entry, const std::string& shown_key) const {
    SweptKey axis{{entry.key}, true, entry.mark, {}, {}, ""};
    if (entry.value.entries.empty())
      errors_.add(entry.mark, shown_key + " is empty; expected partial experiments");
    for (const auto& part : entry.value.entries) {
      const std::string name = name_part(part.key);
      if (!is_partial_experiment(part)) {
        errors_.add_unexpected(part, sweep_.key + "." + entry.key + "." + part.key,
                               "the keys of an experiment that differ");
      } else if (std::find(axis.value_names.begin(), axis.value_names.end(), name) !=
                 axis.value_names.end()) {
        errors_.add(part.mark, same_name(shown_key, name));
      } else {
        axis.values.push_back(part.value);
        axis.value_names.push_back(name);
      }
    }
    if (axis.values.size() < std::max<std::size_t>(entry.value.entries.size(), 1)) return std::nullopt;
    return axis;
  }

  static std::string same_name(const std::string& shown_key, const std::string& name) {
    return fmt::format("two values of {} are named {}; expected names that differ", shown_key,
                       in_quotes(name));
  }

  ConfigEntry find_overrides(const ConfigNode& experiment, const Parameter& row) const {
    if (const ConfigEntry* given = experiment.find(row.name())) return *given;
    ConfigEntry none{row.name(), sweep_.mark, {}};
    none.value.kind = Kind::map;
    none.value.mark = sweep_.mark;
    return none;
  }

  bool is_too_large(std::size_t count, const ConfigNode& experiment) const {
    std::size_t size = count_nodes(experiment);
    for (const auto& key : keys_) {
      count *= key.values.size();
      size += key.size();
      if (count <= max_swept_overrides) continue;
      errors_.add(sweep_.mark, fmt::format("{} makes more than {} combinations; expected fewer",
                                           in_quotes(sweep_.key), max_swept_overrides));
      return true;
    }
    if (count * size <= max_override_nodes) return false;
    errors_.add(sweep_.mark,
                fmt::format("{} makes {} combinations; expected fewer for an experiment of this size",
                            in_quotes(sweep_.key), count));
    return true;
  }

  /// Each of the overrides with each value of the key laid over it.
  std::vector<ConfigEntry> combine(const std::vector<ConfigEntry>& overrides, const SweptKey& key) const {
    std::vector<ConfigEntry> all;
    for (const auto& entry : overrides) {
      for (std::size_t i = 0; i < key.values.size(); ++i) {
        ConfigEntry next{entry.key + (entry.key.empty() ? "" : ",") + key.name + "=" + key.value_names[i],
                         entry.mark, entry.value};
        next.value.kind = Kind::map;
        const ConfigNode value = key.is_axis ? key.values[i] : under_keys(key.path, key.mark, key.values[i]);
        overlay_.lay_over(next.value, value, {.fragments = true, .keep_places = false});
        all.push_back(std::move(next));
      }
    }
    return all;
  }

  void check_lengths(const std::vector<ConfigEntry>& overrides) const {
    const auto is_longer = [](const auto& a, const auto& b) { return a.key.size() < b.key.size(); };
    const auto longest = std::max_element(overrides.begin(), overrides.end(), is_longer);
    if (longest->key.size() <= max_name_length) return;
    errors_.add(sweep_.mark,
                fmt::format("{} makes a name of {} letters, {}; expected at most {}", in_quotes(sweep_.key),
                            longest->key.size(), in_quotes(longest->key), max_name_length));
  }

  const ConfigEntry& sweep_;
  const ConfigOverlay& overlay_;
  ConfigErrors& errors_;
  std::vector<SweptKey> keys_;
};

}  // namespace

bool is_of_folder_name(unsigned char letter) {
  constexpr std::string_view signs = "_-.+=,()[]@~! ";
  return letter >= 0x80 || std::isalnum(letter) != 0 || signs.find(static_cast<char>(letter)) != signs.npos;
}

std::vector<SweptValue> swept_values(const std::string& name) {
  std::vector<SweptValue> values;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i <= name.size(); ++i) {
    if (i < name.size() && name[i] == '[') ++depth;
    if (i < name.size() && name[i] == ']') --depth;
    if (i < name.size() && (name[i] != ',' || depth > 0)) continue;
    const std::string part = name.substr(begin, i - begin);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      values.push_back({"", part});
    else
      values.push_back({part.substr(0, equals), part.substr(equals + 1)});
    begin = i + 1;
  }
  return values;
}

void expand_sweeps(ConfigNode& experiment, const ParameterTable& root, const ConfigOverlay& overlay,
                   ConfigErrors& errors) {
  for (const auto& row : root.rows()) {
    if (row.swept_by().empty()) continue;
    if (const auto sweep = experiment.take(row.swept_by()))
      Sweep(*sweep, overlay, errors).expand(experiment, row);
  }
}

}  // namespace pliant
