#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the linear solver `automatic`: whichever of the others serves a problem best, by what its energies
/// declare and its size.
void register_automatic(Registry& registry);

}  // namespace pliant
