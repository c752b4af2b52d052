#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// The window around all depth that is left after the cut, but for specks [thesis 3.1]: see window_of_parts.
void register_bounding_box(Registry& registry);

}  // namespace pliant
