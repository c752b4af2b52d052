#pragma once

#include <memory>
#include <optional>
#include <string>

#include "framework/config/config_tree.h"

namespace pliant {

/// Whether the text is well-formed UTF-8, the one encoding that results can be written in.
bool is_utf8(const std::string& text);

/// Looks for a slip that YAML's own errors do not name, and which no error says where it is: a tab in the
/// indentation of the line `last_line` (from 1), or in it or before a key whose colon no space follows. Adds
/// an error and returns true where there is one.
bool report_slip(const std::string& text, int last_line, const std::shared_ptr<const ConfigOrigin>& origin,
                 ConfigErrors& errors);

/// Reads one YAML document. Anchors are expanded in place. Keys that stand twice are reported and the first
/// one counts; when the text cannot be understood at all the result is empty. Text that would make an
/// unreasonably large or deep tree is refused.
std::optional<ConfigNode> read_yaml(const std::string& text,
                                    const std::shared_ptr<const ConfigOrigin>& origin, ConfigErrors& errors);

}  // namespace pliant
