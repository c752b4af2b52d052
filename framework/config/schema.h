#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "framework/core/registry.h"

namespace pliant {

/// A JSON Schema (draft-07) of experiment files, for editors: completion, documentation and marks under what
/// is wrong. Sections may be partial in it, because what is missing may stand in the file that is extended.
nlohmann::ordered_json json_schema(const ParameterTable& root, const Registry& registry);

/// A component's documentation for the terminal: what it is, and its table of parameters.
std::string describe(const ComponentInfo& info);

/// Every component with its line of documentation, by kind; of one kind where `kind` is given.
/// Throws ConfigError when there is no such kind.
std::string list_components(const Registry& registry, const std::string& kind = "");

}  // namespace pliant
