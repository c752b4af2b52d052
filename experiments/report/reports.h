#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds `surfaces`, `pictures` and `page`.
void register_reports(Registry& registry);

}  // namespace pliant
