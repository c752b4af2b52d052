#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the report `pictures`: the pictures of a run as PNG files.
void register_pictures_report(Registry& registry);

}  // namespace pliant
