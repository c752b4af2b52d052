#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the graph `uniform`: a node at the centre of each cell of a grid over the source's projection.
void register_uniform_graph(Registry& registry);

}  // namespace pliant
