#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the solver `gauss_newton` [thesis 4.6].
void register_gauss_newton(Registry& registry);

}  // namespace pliant
