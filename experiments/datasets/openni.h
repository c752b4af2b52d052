#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the source `openni`: a camera that OpenNI2 drives, or a recording of one.
void register_openni(Registry& registry);

}  // namespace pliant
