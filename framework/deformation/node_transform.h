#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// How the unknowns of a node make its affine form (see affine_size in warp.h).
struct NodeTransform {
  static constexpr const char* kind = "transform";
  int unknowns = 0;  ///< per node
};

/// Adds `affine` (12 unknowns, the affine form itself) [thesis 4.1].
void register_transforms(Registry& registry);

}  // namespace pliant
