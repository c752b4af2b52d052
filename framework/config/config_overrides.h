#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "framework/config/config_overlay.h"
#include "framework/config/config_tree.h"
#include "framework/core/parameters.h"

namespace pliant {

/// How many values all overrides together may have once each is laid over the whole experiment.
inline constexpr std::size_t max_override_nodes = 1000000;

inline constexpr const char* expected_overrides = "a section with a partial experiment under each name";

/// The table of an override: overrides may not hold overrides, nor a group that has some.
ParameterTable without_overrides(const ParameterTable& root);

/// Makes each entry of an `overrides` parameter a whole experiment: this one without its overrides, with the
/// entry laid over it. Every value keeps its place. What is no partial experiment is reported and left out.
ConfigNode complete_overrides(const ConfigNode& experiment, const ParameterTable& root,
                              const ConfigOverlay& overlay, ConfigErrors& errors);

/// The way back once all is resolved: of each override what was given in `experiment`.
void keep_given_overrides(nlohmann::ordered_json& resolved, const ConfigNode& experiment,
                          const ParameterTable& root);

}  // namespace pliant
