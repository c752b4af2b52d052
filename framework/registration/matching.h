#pragma once

#include <string>

#include "framework/device/device.h"

namespace pliant {

/// A kernel of matching.cl.
cl::Kernel matching_kernel(Device& device, const std::string& name);

}  // namespace pliant
