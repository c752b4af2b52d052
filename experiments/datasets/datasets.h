#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds every frame source that comes with the project.
void register_datasets(Registry& registry);

}  // namespace pliant
