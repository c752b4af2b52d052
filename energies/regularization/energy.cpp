#include "energies/energies.h"
#include "energies/regularization/equation.h"
#include "energies/regularization/equation.h.embed.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_regularization(Registry& registry) {
  add_energy(registry, "regularization", "Makes neighbouring nodes move alike [Eq. 4.4]",
             {.stencil = Stencil::per_edge,
              .residuals = 3,
              .in_length = true,
              .equation = PLIANT_MAKE_SEPARABLE_EQUATION(regularization,
                                                         embedded::energies_regularization_equation_h),
              .weight = 10});
}

}  // namespace pliant
