#include "framework/config/schema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "framework/config/config_overrides.h"
#include "framework/config/config_scalar.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

/// A limit is shown as an integer where it is one: editors print it as it stands.
ordered_json limit(double value) {
  if (std::floor(value) == value && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

ordered_json reference(const std::string& definition) { return {{"$ref", "#/$defs/" + definition}}; }

bool is_section(const Parameter& row) {
  return row.type() == ParameterType::group || row.type() == ParameterType::component ||
         row.type() == ParameterType::components || row.type() == ParameterType::groups ||
         row.type() == ParameterType::overrides;
}

std::string default_shown(const Parameter& row) {
  if (!row.default_names().empty()) return fmt::format("{}", fmt::join(row.default_names(), ", "));
  if (row.is_optional()) return "(none)";
  if (!row.default_text()) return "required";
  if (row.type() == ParameterType::text) return "\"" + *row.default_text() + "\"";
  return *row.default_text();
}

std::string description(const Parameter& row) {
  std::string text = row.doc();
  if (!row.unit().empty()) text += " [" + row.unit() + "]";
  const std::string shown = default_shown(row);
  if (row.is_optional() && row.default_names().empty())
    text += " (optional)";
  else if (shown == "required")
    text += " (required)";
  else if (!shown.empty())
    text += " (default: " + shown + ")";
  return text;
}

class SchemaWriter {
 public:
  SchemaWriter(const ParameterTable& root, const Registry& registry) : root_(root), registry_(registry) {}

  ordered_json write() const {
    ordered_json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                           {"title", "Pliant experiment"}};
    schema.update(table(root_));
    schema["properties"]["extends"] = {
        {"type", "string"},
        {"description", "Another experiment file that this one is laid over, absolute or relative to it"}};
    // What a file leaves out may stand in the one that it extends, or in each of its overrides.
    ordered_json elsewhere = ordered_json::array({{{"required", {"extends"}}}});
    for (const auto& row : root_.rows()) {
      if (row.type() != ParameterType::overrides) continue;
      elsewhere.push_back({{"required", {row.name()}}});
      if (!row.swept_by().empty()) elsewhere.push_back({{"required", {row.swept_by()}}});
    }
    schema["if"] = {{"anyOf", elsewhere}};
    schema["else"] = {{"required", required_keys()}};
    schema["$defs"] = definitions();
    return schema;
  }

 private:
  ordered_json table(const ParameterTable& table) const {
    ordered_json properties = ordered_json::object();
    for (const auto& row : table.rows()) {
      properties[row.name()] = property(row);
      if (!row.swept_by().empty()) properties[row.swept_by()] = sweep(row);
    }
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  }

  static ordered_json sweep(const Parameter& row) {
    const ordered_json value = {
        {"anyOf", ordered_json::array({bare_text(), {{"type", "array"}, {"items", bare_text()}}})}};
    const ordered_json list = {{"type", "array"}, {"items", value}, {"minItems", 1}, {"uniqueItems", true}};
    const ordered_json axis = {
        {"type", "object"}, {"additionalProperties", or_empty(reference("override"))}, {"minProperties", 1}};
    return {{"description",
             "Lists of values under dotted keys, such as 'data.noise: [0, 1]', or partial experiments under "
             "names, such as 'method: {fine: {graph: {nodes: 400}}}'; each combination of them becomes one "
             "of '" +
                 row.name() + "'"},
            {"type", "object"},
            {"additionalProperties", {{"anyOf", ordered_json::array({list, axis})}}}};
  }

  ordered_json required_keys() const {
    ordered_json keys = ordered_json::array();
    for (const auto& row : root_.rows()) {
      if (!row.default_text() && !row.is_optional()) keys.push_back(row.name());
    }
    return keys;
  }

  ordered_json property(const Parameter& row) const {
    ordered_json schema = {{"description", description(row)}};
    // Beside a bare "$ref" draft-07 ignores every other key, the description among them.
    if (row.type() == ParameterType::component)
      schema["allOf"] = ordered_json::array({reference(row.kind())});
    else
      schema.update(value(row));
    if (row.default_text() && !is_section(row)) schema["default"] = typed_default(row);
    // Limits of a list are those of its items.
    ordered_json& limited = row.type() == ParameterType::reals ? schema["items"] : schema;
    if (row.lowest()) limited[lowest_key(row)] = limit(*row.lowest());
    if (row.highest()) limited["maximum"] = limit(*row.highest());
    if (row.step() > 1) schema["multipleOf"] = row.step();
    return schema;
  }

  static const char* lowest_key(const Parameter& row) {
    if (row.type() == ParameterType::components || row.type() == ParameterType::groups)
      return "minProperties";
    return row.lowest_excluded() ? "exclusiveMinimum" : "minimum";
  }

  ordered_json value(const Parameter& row) const {
    switch (row.type()) {
      case ParameterType::boolean:
        return {{"type", "boolean"}};
      case ParameterType::integer:
        return {{"type", "integer"}};
      case ParameterType::real:
        return {{"type", "number"}};
      case ParameterType::choice:
        return {{"enum", row.choices()}};
      case ParameterType::group:
        return table(row.table());
      case ParameterType::components:
        return labelled_components(row.kind());
      case ParameterType::groups:
        return {{"type", "object"}, {"additionalProperties", or_empty(table(row.table()))}};
      case ParameterType::overrides:
        return {{"type", "object"}, {"additionalProperties", or_empty(reference("override"))}};
      case ParameterType::words:
        return {{"type", {"array", "string", "number", "boolean"}}, {"items", bare_text()}};
      case ParameterType::reals:
        return {{"type", "array"},
                {"items", {{"type", "number"}}},
                {"minItems", row.size()},
                {"maxItems", row.size()}};
      default:
        return bare_text();
    }
  }

  /// A text without quotes that happens to look like a number is still a text to the reader.
  static ordered_json bare_text() { return {{"type", {"string", "number", "boolean"}}}; }

  static ordered_json or_empty(const ordered_json& schema) {
    return {{"anyOf", ordered_json::array({schema, {{"type", "null"}}})}};
  }

  ordered_json labelled_components(const std::string& kind) const {
    ordered_json properties = ordered_json::object();
    for (const auto* info : registry_.components(kind)) {
      const ordered_json section = {{"if", {{"required", {"type"}}}},
                                    {"then", reference(kind)},
                                    {"else", reference(kind + "." + info->name)}};
      properties[info->name] = or_empty(section);
      properties[info->name]["description"] = info->doc;
    }
    return {
        {"type", "object"}, {"properties", properties}, {"additionalProperties", or_empty(reference(kind))}};
  }

  ordered_json definitions() const {
    ordered_json all = ordered_json::object();
    for (const auto& kind : referenced_kinds()) {
      all[kind] = any_component(kind);
      for (const auto* info : registry_.components(kind)) all[kind + "." + info->name] = one_component(*info);
    }
    all["override"] = table(without_overrides(root_));
    all["override"]["properties"]["extends"] = {
        {"type", "string"}, {"description", "Another experiment file, of one run, that this is laid over"}};
    return all;
  }

  /// The kinds that there are, and those that a table asks for though nothing of the kind is registered.
  std::vector<std::string> referenced_kinds() const {
    std::vector<std::string> kinds = registry_.kinds();
    add_kinds(root_, kinds);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      for (const auto* info : registry_.components(kinds[i])) add_kinds(info->parameters, kinds);
    }
    return kinds;
  }

  static void add_kinds(const ParameterTable& table, std::vector<std::string>& kinds) {
    for (const auto& row : table.rows()) {
      if (row.type() == ParameterType::group || row.type() == ParameterType::groups)
        add_kinds(row.table(), kinds);
      if (!row.kind().empty() && std::find(kinds.begin(), kinds.end(), row.kind()) == kinds.end())
        kinds.push_back(row.kind());
    }
  }

  /// Either a bare name or a section whose `type` says which component's keys it has.
  ordered_json any_component(const std::string& kind) const {
    ordered_json names = ordered_json::array();
    ordered_json by_type = ordered_json::array();
    ordered_json untyped = ordered_json::array();
    for (const auto* info : registry_.components(kind)) {
      const ordered_json definition = reference(kind + "." + info->name);
      names.push_back(info->name);
      untyped.push_back(definition);
      by_type.push_back(
          {{"if", {{"required", {"type"}}, {"properties", {{"type", {{"const", info->name}}}}}}},
           {"then", definition}});
    }
    // Without a type the section may be any of them: the type may stand in the file that is extended.
    if (!untyped.empty())
      by_type.push_back({{"if", {{"required", {"type"}}}}, {"else", {{"anyOf", untyped}}}});
    const ordered_json name = {{"enum", names}};
    ordered_json section = {{"type", "object"}, {"properties", {{"type", name}}}};
    if (!by_type.empty()) section["allOf"] = by_type;
    return {{"oneOf", ordered_json::array({name, section})}};
  }

  ordered_json one_component(const ComponentInfo& info) const {
    ordered_json schema = {{"description", info.doc}};
    schema.update(table(info.parameters));
    schema["properties"]["type"] = {{"const", info.name}, {"description", info.doc}};
    return schema;
  }

  const ParameterTable& root_;
  const Registry& registry_;
};

constexpr std::size_t columns = 6;
using Line = std::array<std::string, columns>;

std::string type_shown(const Parameter& row) {
  switch (row.type()) {
    case ParameterType::boolean:
      return "true/false";
    case ParameterType::integer:
      return "integer";
    case ParameterType::real:
      return "number";
    case ParameterType::text:
      return "text";
    case ParameterType::choice:
      return "choice";
    case ParameterType::path:
      return "file";
    case ParameterType::component:
      return row.kind();
    case ParameterType::components:
      return "map of " + row.kind();
    case ParameterType::group:
      return "section";
    case ParameterType::groups:
      return "map of sections";
    case ParameterType::overrides:
      return "overrides";
    case ParameterType::words:
      return "list of texts";
    case ParameterType::reals:
      return fmt::format("{} numbers", row.size());
  }
  throw std::logic_error("a parameter type without a name");
}

std::string range_shown(const Parameter& row) {
  if (row.type() == ParameterType::choice) return fmt::format("{}", fmt::join(row.choices(), ", "));
  return range_text(row);
}

void add_lines(const ParameterTable& table, const std::string& prefix, std::vector<Line>& lines) {
  for (const auto& row : table.rows()) {
    const std::string name = prefix + row.name();
    lines.push_back({name, type_shown(row), row.unit(), default_shown(row), range_shown(row), row.doc()});
    if (row.type() == ParameterType::group) add_lines(row.table(), name + ".", lines);
    if (row.type() == ParameterType::groups) add_lines(row.table(), name + ".NAME.", lines);
  }
}

/// Lines under a head; a column that is empty in all of them is left out.
std::string aligned(const Line& head, std::vector<Line> lines) {
  std::array<std::size_t, columns> widths{};
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < columns; ++i) {
      if (!line[i].empty()) widths[i] = std::max({widths[i], line[i].size(), head[i].size()});
    }
  }
  lines.insert(lines.begin(), head);
  std::string text;
  for (const auto& line : lines) {
    std::string row = " ";
    for (std::size_t i = 0; i < columns; ++i) {
      if (widths[i] > 0) row += fmt::format(" {:<{}}", line[i], widths[i] + 1);
    }
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

ordered_json json_schema(const ParameterTable& root, const Registry& registry) {
  return SchemaWriter(root, registry).write();
}

std::string describe(const ComponentInfo& info) {
  const std::string head = fmt::format("{} ({})\n  {}\n\n", info.name, info.kind, info.doc);
  if (info.parameters.rows().empty()) return head + "  It has no parameters.\n";
  std::vector<Line> lines;
  add_lines(info.parameters, "", lines);
  return head + aligned({"parameter", "type", "unit", "default", "range", "what it is"}, std::move(lines));
}

std::string list_components(const Registry& registry, const std::string& kind) {
  std::vector<std::string> kinds = registry.kinds();
  if (!kind.empty()) {
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      throw ConfigError(fmt::format("unknown kind of component '{}'; expected one of {}{}", kind,
                                    fmt::join(kinds, ", "), suggestion(kind, kinds)));
    kinds = {kind};
  }
  std::string text;
  for (const auto& each : kinds) {
    text += (text.empty() ? "" : "\n") + each + "\n";
    std::size_t width = 0;
    for (const auto* info : registry.components(each)) width = std::max(width, info->name.size());
    for (const auto* info : registry.components(each))
      text += fmt::format("  {:<{}}  {}\n", info->name, width, info->doc);
  }
  return text;
}

}  // namespace pliant
