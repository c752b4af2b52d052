#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds `none`, `features`, `icp` and `automatic`.
void register_alignments(Registry& registry);

}  // namespace pliant
