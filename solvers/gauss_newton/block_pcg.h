#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the linear solver `block_pcg`: conjugate gradients over the 12x12 blocks of J^T J that are not zero,
/// preconditioned by the inverses of the diagonal ones. For any energy; memory grows with nodes and
/// constraints only.
void register_block_pcg(Registry& registry);

}  // namespace pliant
