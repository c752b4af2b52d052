#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the sampler `uniform` [thesis 4.5, first iteration].
void register_uniform_sampler(Registry& registry);

}  // namespace pliant
