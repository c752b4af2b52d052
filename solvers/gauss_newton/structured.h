#pragma once

#include <string>

#include "framework/core/registry.h"
#include "framework/problem/problem.h"

namespace pliant {

/// Adds the linear solver `structured`: conjugate gradients over J^T J = M (x) I_3 for what treats the axes
/// apart, and 12x12 blocks of the nodes. 16 numbers a pair of nodes; nothing is factored but the blocks.
void register_structured(Registry& registry);

/// Empty when `structured` can serve the problem, else what it cannot.
std::string structured_obstacle(const Problem& problem);

}  // namespace pliant
