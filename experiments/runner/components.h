#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds every component that comes with the project, of every kind.
void register_everything(Registry& registry);

}  // namespace pliant
