#pragma once

#include "framework/core/registry.h"
#include "samplers/adaptive/adaptive.h"
#include "samplers/uniform/uniform.h"

namespace pliant {

/// Adds every constraint sampler.
inline void register_samplers(Registry& registry) {
  register_adaptive_sampler(registry);
  register_uniform_sampler(registry);
}

}  // namespace pliant
