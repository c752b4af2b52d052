#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds every data source that comes with the project.
void register_datasets(Registry& registry);

}  // namespace pliant
