#pragma once

#include "framework/core/registry.h"

namespace pliant {

void register_approaching_wall(Registry& registry);

}  // namespace pliant
