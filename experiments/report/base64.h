#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

/// RFC 4648 with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace pliant
