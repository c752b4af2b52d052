#pragma once

#include <string>
#include <string_view>

namespace pliant {

/// `source` behind reductions.cl, for work-groups of `group_size` (a power of two) work-items where it has
/// any.
std::string with_reductions(std::string_view source, std::size_t group_size = 1);

}  // namespace pliant
