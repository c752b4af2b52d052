#include <algorithm>
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
      registry, "stillness", "Keeps each node where it is",
      {.stencil = pliant::Stencil::per_node,
       .residuals = 3,
       .in_length = true,
       .equation = PLIANT_MAKE_EQUATION(stillness, pliant::embedded::energies_stillness_equation_h)});
}

/// How far the farthest point goes, in mm, from a wall to one that is 5 mm nearer.
float motion(const std::string& set) {
  const pliant::Camera camera{.fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5, .width = 64, .height = 48};
  const std::vector<float> wall(64 * 48, 800);
  const std::vector<float> nearer(64 * 48, 795);
  pliant::Registry components;
  pliant::register_everything(components);
  register_stillness(components);
  pliant::DepthRegistration registration(
      {.recipe = "extends: methods/ed.yaml\nalignment: none\n", .sets = {set}}, components);
  const auto result = registration.run({.depth = wall}, {.depth = nearer}, camera);
  float farthest = 0;
  for (std::size_t i = 0; i < result.after.size(); ++i)
    farthest = std::max(farthest, (result.after[i] - result.before[i]).norm());
  return farthest;
}

}  // namespace

// An energy from outside is minimised with those that come with Pliant: with a great weight it keeps the wall
// still.
int main() {
  const float free = motion("energies.rotation.weight=1");
  const float held = motion("energies.stillness.weight=1e6");
  std::printf("the wall moved by %.3f mm, held by %.3f mm\n", free, held);
  return free > 4 && held < 0.1 ? 0 : 1;
}
