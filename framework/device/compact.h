#pragma once

#include <string>
#include <vector>

#include "framework/device/array.h"

namespace pliant {

/// Ascending indices of the values that are not zero, gathered on the device in a fixed order: an exclusive
/// scan of the counts, then every index to its place. Waits once, to learn how many there are.
Array<int> compact(Device& device, const std::string& stage, const Array<int>& flags);

/// Plain C++ reference of compact.
std::vector<int> compact_reference(const std::vector<int>& flags);

}  // namespace pliant
