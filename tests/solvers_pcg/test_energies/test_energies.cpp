#include "tests/solvers_pcg/test_energies/test_energies.h"

#include "framework/problem/make_equation.h"
#include "tests/solvers_pcg/test_energies/equation.h"
#include "tests/solvers_pcg/test_energies/equation.h.embed.h"

namespace pliant::test {
namespace {

constexpr auto kSource = embedded::tests_solvers_pcg_test_energies_equation_h;

Energy make(Stencil stencil, int residuals, Equation equation, double weight) {
  return {.stencil = stencil,
          .residuals = residuals,
          .in_length = true,
          .equation = std::move(equation),
          .weight = weight};
}

}  // namespace

Energy to_plane() { return make(Stencil::per_constraint, 1, PLIANT_MAKE_EQUATION(to_plane, kSource), 100); }
Energy moves_as_far() {
  return make(Stencil::per_constraint, 1, PLIANT_MAKE_EQUATION(moves_as_far, kSource), 2e-4);
}
Energy keeps_length() {
  return make(Stencil::per_edge, 1, PLIANT_MAKE_EQUATION(keeps_length, kSource), 0.002);
}
Energy stays() { return make(Stencil::per_node, 3, PLIANT_MAKE_SEPARABLE_EQUATION(stays, kSource), 2); }

}  // namespace pliant::test
