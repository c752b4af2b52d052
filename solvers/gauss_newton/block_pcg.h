#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the linear solver `block_pcg`: conjugate gradients over the blocks of J^T J (12x12 where nodes are
/// affine) that are not zero, preconditioned by the inverses of the diagonal ones. For any energy and
/// transform; memory grows with nodes and constraints only.
void register_block_pcg(Registry& registry);

}  // namespace pliant
