#pragma once

#include <memory>
#include <optional>
#include <string>

#include "framework/core/config_tree.h"

namespace pliant {

/// Whether the text is well-formed UTF-8, the one encoding that results can be written in.
bool is_utf8(const std::string& text);

/// Reads one YAML document. Anchors are expanded in place. Keys that stand twice are reported and the first
/// one counts; when the text cannot be understood at all the result is empty. Text that would make an
/// unreasonably large or deep tree is refused.
std::optional<ConfigNode> read_yaml(const std::string& text,
                                    const std::shared_ptr<const ConfigOrigin>& origin, ConfigErrors& errors);

}  // namespace pliant
