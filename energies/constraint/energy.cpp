#include "energies/constraint/equation.h"
#include "energies/constraint/equation.h.embed.h"
#include "energies/energies.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_constraint(Registry& registry) {
  add_energy(
      registry, "constraint", "Pulls each constrained point to its matched target point [Eq. 4.5]",
      {.stencil = Stencil::per_constraint,
       .residuals = 3,
       .in_length = true,
       .equation = PLIANT_MAKE_SEPARABLE_EQUATION(constraint, embedded::energies_constraint_equation_h),
       .weight = 100});
}

}  // namespace pliant
