#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// The energies there are, by the names of their folders, in the order in which they are listed.
/// A new energy is its own folder and its name on this line (docs/adding-a-component.md).
#define PLIANT_ENERGIES(ENERGY) \
  ENERGY(rotation)              \
  ENERGY(regularization) ENERGY(constraint) ENERGY(point_to_plane) ENERGY(feature) ENERGY(displacement)

#define PLIANT_DECLARE_ENERGY(NAME) void register_##NAME(Registry& registry);
PLIANT_ENERGIES(PLIANT_DECLARE_ENERGY)
#undef PLIANT_DECLARE_ENERGY

/// Adds every energy.
void register_energies(Registry& registry);

}  // namespace pliant
