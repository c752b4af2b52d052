#pragma once

#include "framework/core/registry.h"
#include "graphs/quadtree/quadtree.h"
#include "graphs/uniform/uniform.h"

namespace pliant {

/// Adds every graph builder.
inline void register_graphs(Registry& registry) {
  register_quadtree_graph(registry);
  register_uniform_graph(registry);
}

}  // namespace pliant
