#pragma once

#include <string>
#include <vector>

#include "experiments/modeller/figure.h"
#include "framework/core/registry.h"

namespace pliant {

/// Adds a frame source for each kind of figure, called as it is, and `gltf` for meshes in files.
void register_figures(Registry& registry, const std::vector<FigureKind>& kinds);
void register_gltf(Registry& registry);

}  // namespace pliant
