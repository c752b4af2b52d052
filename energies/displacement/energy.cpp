#include "energies/displacement/equation.h"
#include "energies/displacement/equation.h.embed.h"
#include "energies/energies.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_displacement(Registry& registry) {
  add_energy(registry, "displacement",
             "Keeps each node where the alignment put it: what nothing pulls, or what is hidden, stays. With "
             "loss `huber` it holds back small motions more than it shortens large ones",
             {.stencil = Stencil::per_node,
              .residuals = 3,
              .in_length = true,
              .equation = PLIANT_MAKE_EQUATION(displacement, embedded::energies_displacement_equation_h),
              .weight = 1});
}

}  // namespace pliant
