#include "energies/energies.h"
#include "energies/stillness/equation.h"
#include "energies/stillness/equation.h.embed.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_stillness(Registry& registry) {
  add_energy(registry, "stillness", "Keeps each node where it is",
             {.stencil = Stencil::per_node,
              .residuals = 3,
              .in_length = true,
              .equation = PLIANT_MAKE_EQUATION(stillness, embedded::energies_stillness_equation_h),
              .weight = 0.1});
}

}  // namespace pliant
