#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// The object as a mask image shows it, once for all frames. A mask that is black all over is a DataError,
/// and so is one of another size than the depth; it is not found in a frame without depth on it.
void register_mask(Registry& registry);

}  // namespace pliant
