#pragma once

#include <optional>
#include <string>

#include "framework/config/config_tree.h"
#include "framework/core/registry.h"

namespace pliant {

/// Lays partial experiments over others. Maps merge key by key and the overlay wins, but a section that
/// names another component than the one beneath replaces it whole: its keys mean something else.
class ConfigOverlay {
 public:
  struct Mode {
    /// Both sides are fragments, so a section that names no component may still be of any.
    bool fragments = false;
    /// A section found on both sides is reported at its place in the base.
    bool keep_places = false;
  };

  ConfigOverlay(const ParameterTable& root, const Registry& registry) : root_(root), registry_(registry) {}

  /// Lays the map `overlay` over the map `base`, both experiments or fragments of one.
  void lay_over(ConfigNode& base, const ConfigNode& overlay, Mode mode) const;

 private:
  void lay_over(ConfigNode& base, const ConfigNode& overlay, const ParameterTable* table, Mode mode) const;
  void lay_over(ConfigEntry& base, const ConfigEntry& overlay, const Parameter* row, Mode mode) const;
  void lay_over_labels(ConfigNode& base, const ConfigNode& overlay, const Parameter& row, Mode mode) const;
  void lay_over_component(ConfigEntry& base, const ConfigEntry& overlay, const std::string& kind,
                          const std::optional<std::string>& implied, Mode mode) const;

  const ParameterTable& root_;
  const Registry& registry_;
};

}  // namespace pliant
