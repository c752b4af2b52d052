#include "framework/config/config_resolver.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>

#include <fmt/format.h>

#include "framework/core/nearest.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Kind = ConfigNode::Kind;

// How many values all overrides together may have once each is laid over the whole experiment.
constexpr std::size_t max_override_nodes = 1000000;

std::string shown(const ConfigNode& node) {
  switch (node.kind) {
    case Kind::null:
      return "empty";
    case Kind::list:
      return "a list";
    case Kind::map:
      return "a section";
    default:
      return (node.quoted ? "the quoted text " : "") + in_quotes(node.text);
  }
}

std::string one_of(const std::vector<std::string>& choices) {
  if (choices.empty()) return "none, there is nothing to choose from";
  return fmt::format("{}{}", choices.size() > 1 ? "one of " : "", fmt::join(choices, ", "));
}

/// The finite number that the whole of `text` spells out.
template <class Number>
std::optional<Number> parse_number(const std::string& text) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  // What from_chars takes beside digits ("inf", "-nan", and "-" after the "+" above) is no number here.
  const char* digits = first != last && *first == '-' && first == text.data() ? first + 1 : first;
  if (digits == last || !(std::isdigit(static_cast<unsigned char>(*digits)) != 0 || *digits == '.'))
    return {};
  Number number{};
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last) return {};
  return number;
}

std::optional<bool> parse_boolean(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return {};
}

std::string boolean_hint(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* word : {"yes", "y", "on", "true", "1"})
    if (text == word) return "; did you mean 'true'?";
  for (const char* word : {"no", "n", "off", "false", "0"})
    if (text == word) return "; did you mean 'false'?";
  return "";
}

bool in_range(const Parameter& row, double value) {
  if (row.lowest() && (row.lowest_excluded() ? value <= *row.lowest() : value < *row.lowest())) return false;
  return !row.highest() || value <= *row.highest();
}

/// The scalar that `text` is for this row, or null when it is none or out of range.
ordered_json typed_scalar(const Parameter& row, const std::string& text) {
  if (row.type() == ParameterType::boolean) {
    if (const auto value = parse_boolean(text)) return *value;
    return nullptr;
  }
  if (row.type() == ParameterType::integer) {
    const auto value = parse_number<std::int64_t>(text);
    if (value && in_range(row, static_cast<double>(*value))) return *value;
    return nullptr;
  }
  if (row.type() == ParameterType::real) {
    const auto value = parse_number<double>(text);
    if (value && in_range(row, *value)) return *value;
    return nullptr;
  }
  if (row.type() == ParameterType::choice) {
    const auto& choices = row.choices();
    if (std::find(choices.begin(), choices.end(), text) == choices.end()) return nullptr;
  }
  return text;
}

Parameters::Value typed_value(const std::string& name, const ordered_json& scalar) {
  if (scalar.is_boolean()) return {name, scalar.get<bool>()};
  if (scalar.is_number_integer()) return {name, scalar.get<std::int64_t>()};
  if (scalar.is_number_float()) return {name, scalar.get<double>()};
  if (scalar.is_array()) return {name, scalar.get<std::vector<double>>()};
  return {name, scalar.get<std::string>()};
}

bool takes_quotes(ParameterType type) { return type == ParameterType::text || type == ParameterType::choice; }

/// Of a resolved section, those keys that were given: an override as it is written out again.
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

bool holds_overrides(const Parameter& row) {
  if (row.type() == ParameterType::overrides) return true;
  if (row.type() != ParameterType::group) return false;
  const auto& rows = row.table().rows();
  return std::any_of(rows.begin(), rows.end(), holds_overrides);
}

std::string range_text(const Parameter& row) {
  const std::string highest = row.highest() ? fmt::format("{}", *row.highest()) : "";
  if (!row.lowest()) return highest.empty() ? "" : "at most " + highest;
  if (row.lowest_excluded())
    return fmt::format("above {}{}{}", *row.lowest(), highest.empty() ? "" : " and at most ", highest);
  if (highest.empty()) return fmt::format("at least {}", *row.lowest());
  return fmt::format("from {} to {}", *row.lowest(), highest);
}

ordered_json typed_default(const Parameter& row) {
  if (!row.default_text()) return nullptr;
  if (row.type() == ParameterType::reals)
    return ordered_json::parse(*row.default_text()).get<std::vector<double>>();
  ordered_json value = typed_scalar(row, *row.default_text());
  if (value.is_null())
    throw std::logic_error("the default of parameter '" + row.name() + "' is not allowed by its own row");
  return value;
}

ConfigResolver::ConfigResolver(const ParameterTable& root, const Registry& registry,
                               std::vector<std::filesystem::path> data_folders, ConfigErrors& errors)
    : root_(root), registry_(registry), data_folders_(std::move(data_folders)), errors_(errors) {}

ResolvedSection ConfigResolver::experiment(const ConfigNode& tree) {
  experiment_ = &tree;
  return section(&tree, root_, {"", tree.mark}, "", {"extends"});
}

bool ConfigResolver::is_visible(const Parameter& row) const {
  return !inside_override_ || !holds_overrides(row);
}

std::vector<std::string> ConfigResolver::visible_keys(const ParameterTable& table) const {
  std::vector<std::string> keys;
  for (const auto& row : table.rows()) {
    if (is_visible(row)) keys.push_back(row.name());
  }
  return keys;
}

ResolvedSection ConfigResolver::section(const ConfigNode* node, const ParameterTable& table,
                                        const Place& place, const std::string& component,
                                        const std::vector<std::string>& other_keys) {
  ResolvedSection result;
  if (!component.empty()) result.tree["type"] = component;
  std::vector<Parameters::Value> values;
  for (const auto& row : table.rows()) {
    if (!is_visible(row)) continue;
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
  std::vector<std::string> keys = visible_keys(table);
  keys.insert(keys.end(), other_keys.begin(), other_keys.end());
  for (const auto& entry : node.entries) {
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) continue;
    const std::string where = place.path.empty() ? "" : " in " + in_quotes(place.path);
    errors_.add(entry.mark, fmt::format("unknown key {}{}; expected {}{}", in_quotes(entry.key), where,
                                        one_of(keys), suggestion(entry.key, keys)));
  }
}

ConfigResolver::MaybeResolved ConfigResolver::absent(const Parameter& row, const Place& place) {
  const ParameterType type = row.type();
  const bool is_list = type == ParameterType::components || type == ParameterType::words;
  if (type == ParameterType::overrides || (is_list && row.is_optional())) {
    if (type == ParameterType::words)
      return Resolved{{row.name(), std::vector<std::string>{}}, ordered_json::array()};
    // Left out when it is written again where an empty map would be an error.
    return Resolved{{row.name(), Parameters::Sections{}},
                    row.lowest() ? ordered_json() : ordered_json::object()};
  }
  if (row.is_optional()) return {};
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
    case ParameterType::overrides:
      return overrides(row, entry, place);
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
        item.kind == Kind::scalar && !item.quoted ? parse_number<double>(item.text) : std::nullopt;
    if (number && in_range(row, *number))
      numbers.push_back(*number);
    else
      errors_.add(item.mark, fmt::format("an item of {} is {}; expected {}", in_quotes(place.key(row.name())),
                                         shown(item), expected(row)));
  }
  if (numbers.size() != row.size()) return {};
  return Resolved{{row.name(), numbers}, numbers};
}

ConfigResolver::MaybeResolved ConfigResolver::components(const Parameter& row, const ConfigEntry& entry,
                                                         const Place& place) {
  if (entry.value.kind != Kind::map) {
    report(row, entry, place);
    return {};
  }
  if (row.lowest() && static_cast<double>(entry.value.entries.size()) < *row.lowest()) {
    errors_.add(entry.mark,
                fmt::format("{} has {} entries; expected at least {}", in_quotes(place.key(row.name())),
                            entry.value.entries.size(), *row.lowest()));
    return {};
  }
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

ConfigResolver::MaybeResolved ConfigResolver::overrides(const Parameter& row, const ConfigEntry& entry,
                                                        const Place& place) {
  if (entry.value.kind != Kind::map) {
    report(row, entry, place);
    return {};
  }
  const ConfigNode base = without_overrides();
  if (entry.value.entries.size() * count_nodes(base) > max_override_nodes) {
    errors_.add(entry.mark, fmt::format("{} has {} entries; expected fewer for an experiment of this size",
                                        in_quotes(place.key(row.name())), entry.value.entries.size()));
    return {};
  }
  const ConfigOverlay overlay(root_, registry_);
  Parameters::Sections sections;
  ordered_json tree = ordered_json::object();
  inside_override_ = true;
  for (const auto& labelled : entry.value.entries) {
    if (labelled.value.kind != Kind::map && labelled.value.kind != Kind::null) {
      errors_.add(labelled.mark,
                  fmt::format("{} is {}; expected the keys of an experiment that differ",
                              in_quotes(place.key(row.name()) + "." + labelled.key), shown(labelled.value)));
      continue;
    }
    ConfigNode whole = base;
    // The places of the base are kept so that an error of its own is the same error here, and told once.
    overlay.lay_over(whole, labelled.value, {.fragments = false, .keep_places = true});
    ResolvedSection resolved = section(&whole, root_, {"", whole.mark}, "", {});
    tree[labelled.key] = given_part(resolved.tree, labelled.value);
    sections.emplace_back(labelled.key, Parameters("", resolved.values.values(), to_string(labelled.mark)));
  }
  inside_override_ = false;
  return Resolved{{row.name(), std::move(sections)}, std::move(tree)};
}

ConfigNode ConfigResolver::without_overrides() const {
  ConfigNode base;
  base.kind = Kind::map;
  base.mark = experiment_->mark;
  for (const auto& entry : experiment_->entries) {
    // A key that the table does not have is left out too: it has been reported for the experiment itself.
    const Parameter* row = root_.find(entry.key);
    if (row != nullptr && !holds_overrides(*row)) base.entries.push_back(entry);
  }
  return base;
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
  // An empty value has no place of its own: the parser puts it where the next key begins.
  const ConfigMark& mark = entry.value.kind == Kind::scalar ? entry.value.mark : entry.mark;
  errors_.add(mark, fmt::format("{} is {}; expected {}{}", in_quotes(place.key(row.name())),
                                shown(entry.value), expected(row), hint));
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
      return fmt::format("a section with keys of {}", fmt::join(visible_keys(row.table()), ", "));
    case ParameterType::overrides:
      return "a section with a partial experiment under each name";
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
