#include "framework/config/config_overlay.h"

namespace pliant {
namespace {

using Kind = ConfigNode::Kind;

/// A bare component name is short for a section that says no more than its type.
ConfigNode as_section(const ConfigNode& node) {
  if (node.kind != Kind::scalar) return node;
  ConfigNode section;
  section.kind = Kind::map;
  section.mark = node.mark;
  section.entries.push_back({"type", node.mark, node});
  return section;
}

/// Under a label an empty section stands for one without keys.
ConfigNode as_labelled_section(const ConfigNode& node) {
  ConfigNode section = as_section(node);
  if (section.kind == Kind::null) section.kind = Kind::map;
  return section;
}

std::optional<std::string> given_type(const ConfigNode& section) {
  const ConfigEntry* type = section.find("type");
  if (type == nullptr) return std::nullopt;
  return type->value.text;
}

bool are_maps(const ConfigEntry& a, const ConfigEntry& b) {
  return a.value.kind == Kind::map && b.value.kind == Kind::map;
}

}  // namespace

void ConfigOverlay::lay_over(ConfigNode& base, const ConfigNode& overlay, Mode mode) const {
  lay_over(base, overlay, &root_, mode);
}

void ConfigOverlay::lay_over(ConfigNode& base, const ConfigNode& overlay, const ParameterTable* table,
                             Mode mode) const {
  for (const auto& entry : overlay.entries) {
    ConfigEntry* beneath = base.find(entry.key);
    if (beneath == nullptr)
      base.entries.push_back(entry);
    else
      lay_over(*beneath, entry, table == nullptr ? nullptr : table->find(entry.key), mode);
  }
  if (!mode.keep_places) base.mark = overlay.mark;
}

void ConfigOverlay::lay_over(ConfigEntry& base, const ConfigEntry& overlay, const Parameter* row,
                             Mode mode) const {
  // Without a row it is not known yet what the key means (a fragment may leave out the type above it); a
  // map on either side shows that it is a section.
  const bool is_section = base.value.kind == Kind::map || overlay.value.kind == Kind::map;
  const ParameterType type = row != nullptr ? row->type()
                             : is_section   ? ParameterType::component
                                            : ParameterType::text;
  switch (type) {
    case ParameterType::component:
      return lay_over_component(base, overlay, row == nullptr ? "" : row->kind(),
                                row == nullptr ? std::nullopt : row->default_text(), mode);
    case ParameterType::components:
    case ParameterType::groups:
    case ParameterType::overrides:
      if (!are_maps(base, overlay)) break;
      lay_over_labels(base.value, overlay.value, *row, mode);
      if (!mode.keep_places) base.mark = overlay.mark;
      return;
    case ParameterType::group:
      if (!are_maps(base, overlay)) break;
      lay_over(base.value, overlay.value, &row->table(), mode);
      if (!mode.keep_places) base.mark = overlay.mark;
      return;
    default:
      break;
  }
  base = overlay;
}

void ConfigOverlay::lay_over_labels(ConfigNode& base, const ConfigNode& overlay, const Parameter& row,
                                    Mode mode) const {
  for (const auto& entry : overlay.entries) {
    ConfigEntry* beneath = base.find(entry.key);
    if (beneath == nullptr) {
      base.entries.push_back(entry);
    } else if (row.type() == ParameterType::components) {
      beneath->value = as_labelled_section(beneath->value);
      const ConfigEntry section{entry.key, entry.mark, as_labelled_section(entry.value)};
      lay_over_component(*beneath, section, row.kind(), entry.key, mode);
    } else if (are_maps(*beneath, entry) && row.type() == ParameterType::groups) {
      lay_over(beneath->value, entry.value, &row.table(), mode);
      if (!mode.keep_places) beneath->mark = entry.mark;
    } else if (are_maps(*beneath, entry)) {
      lay_over(beneath->value, entry.value, &root_, {.fragments = true, .keep_places = mode.keep_places});
    } else if (entry.value.kind != Kind::null) {
      *beneath = entry;
    }
  }
}

void ConfigOverlay::lay_over_component(ConfigEntry& base, const ConfigEntry& overlay, const std::string& kind,
                                       const std::optional<std::string>& implied, Mode mode) const {
  ConfigNode beneath = as_section(base.value);
  const ConfigNode above = as_section(overlay.value);
  if (beneath.kind != Kind::map || above.kind != Kind::map) {
    base = overlay;
    return;
  }
  std::optional<std::string> type = given_type(beneath);
  if (!type && !mode.fragments) type = implied;
  const std::optional<std::string> wanted = given_type(above);
  const bool any_type = !type && mode.fragments;
  if (wanted && wanted != type && !any_type) {
    base = overlay;
    return;
  }
  const ComponentInfo* info = nullptr;
  if (const auto& known = wanted ? wanted : type) info = registry_.find(kind, *known);
  lay_over(beneath, above, info == nullptr ? nullptr : &info->parameters, mode);
  base.value = std::move(beneath);
  if (!mode.keep_places) base.mark = overlay.mark;
}

}  // namespace pliant
