#include "energies/energies.h"
#include "energies/rotation/equation.h"
#include "energies/rotation/equation.h.embed.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_rotation(Registry& registry) {
  add_energy(registry, "rotation", "Keeps each node's matrix near a rotation [Eq. 4.2, 4.3]",
             {.stencil = Stencil::per_node,
              .residuals = 6,
              .in_length = false,
              .equation = PLIANT_MAKE_EQUATION(rotation, embedded::energies_rotation_equation_h),
              .weight = 1});
}

}  // namespace pliant
