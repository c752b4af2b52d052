#include <cstdio>
#include <string>
#include <vector>

#include "energies/stillness/equation.h"
#include "energies/stillness/equation.h.embed.h"
#include "pliant/make_equation.h"
#include "pliant/pliant.h"

namespace {

void register_stillness(pliant::Registry& registry) {
  pliant::add_energy(
      registry, "stillness", "Keeps each node as it was",
      {.stencil = pliant::Stencil::per_node,
       .residuals = 12,
       .equation = PLIANT_MAKE_EQUATION(stillness, pliant::embedded::energies_stillness_equation_h)});
}

/// How far a wall ends from one that was 5 mm nearer, in mm.
double distance_after(const std::string& set) {
  const pliant::Camera camera{.fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5, .width = 64, .height = 48};
  const std::vector<float> wall(64 * 48, 800);
  const std::vector<float> nearer(64 * 48, 795);
  pliant::Registry components;
  pliant::register_everything(components);
  register_stillness(components);
  pliant::DepthRegistration registration(
      {.recipe = "extends: methods/ed.yaml\nalignment: none\n", .sets = {set}}, components);
  return registration.run({.depth = wall}, {.depth = nearer}, camera).residual_after;
}

}  // namespace

// An energy from outside is minimised with those that come with Pliant: with a great weight it keeps the wall
// from its target.
int main() {
  const double without = distance_after("energies.rotation.weight=1");
  const double with = distance_after("energies.stillness.weight=1e6");
  std::printf("the wall ends %.3f mm off, with an energy that holds it %.3f mm\n", without, with);
  return without < 0.1 && with > 4 ? 0 : 1;
}
