#pragma once

#include <string>
#include <string_view>

namespace pliant {

/// `source` behind lanes.cl: vectors of the device's width, and what kernels do with them.
std::string with_lanes(std::string_view source);

}  // namespace pliant
