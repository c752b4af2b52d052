#pragma once

#include "framework/core/registry.h"

namespace pliant {

void register_centroid_alignment(Registry& registry);

}  // namespace pliant
