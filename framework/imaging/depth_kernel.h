#pragma once

#include <string>

#include "framework/device/device.h"

namespace pliant {

/// A kernel of depth_map.cl.
cl::Kernel depth_kernel(Device& device, const std::string& name);

}  // namespace pliant
