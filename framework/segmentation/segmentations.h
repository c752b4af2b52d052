#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds `none`, `bounding_box`, `mask` and `haar`.
void register_segmentations(Registry& registry);

}  // namespace pliant
