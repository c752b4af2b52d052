#include "energies/energies.h"
#include "energies/feature/equation.h"
#include "energies/feature/equation.h.embed.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_feature(Registry& registry) {
  add_energy(registry, "feature",
             "Pulls colour features of the source to their matches; without colour it asks for nothing",
             {.stencil = Stencil::per_constraint,
              .residuals = 3,
              .in_length = true,
              .equation = PLIANT_MAKE_SEPARABLE_EQUATION(feature, embedded::energies_feature_equation_h),
              .weight = 100,
              .source = ConstraintSource::features});
}

}  // namespace pliant
