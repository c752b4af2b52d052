#include "energies/energies.h"
#include "energies/point_to_plane/equation.h"
#include "energies/point_to_plane/equation.h.embed.h"
#include "framework/problem/make_equation.h"

namespace pliant {

void register_point_to_plane(Registry& registry) {
  add_energy(registry, "point_to_plane",
             "Pulls each constrained point to the tangent plane at its matched target point",
             {.stencil = Stencil::per_constraint,
              .residuals = 1,
              .in_length = true,
              .equation = PLIANT_MAKE_EQUATION(point_to_plane, embedded::energies_point_to_plane_equation_h),
              .weight = 100});
}

}  // namespace pliant
