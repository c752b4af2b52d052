#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds `none` and `features`.
void register_alignments(Registry& registry);

}  // namespace pliant
