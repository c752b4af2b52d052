#include "solvers/gauss_newton/structured/kernels.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/device/lanes.h"
#include "framework/problem/equation_source.h"
#include "solvers/gauss_newton/reductions.h"
#include "solvers/gauss_newton/structured/assembly.cl.embed.h"
#include "solvers/gauss_newton/structured/conjugate_gradients.cl.embed.h"
#include "solvers/gauss_newton/structured/instance_terms.cl.embed.h"
#include "solvers/gauss_newton/structured/layout.cl.embed.h"
#include "solvers/gauss_newton/structured/minimiser.cl.embed.h"
#include "solvers/gauss_newton/structured/node_terms.cl.embed.h"
#include "solvers/gauss_newton/structured/packed.cl.embed.h"

namespace pliant {
namespace {

/// The functions of every term per node, and three that call them all.
std::string node_terms_source(const std::vector<const Term*>& terms) {
  // From the order 4 axis + c to that of the equations.
  std::string text = "#define COLUMNWISE(m) (3 * ((m) % 4) + (m) / 4)\n" + losses_source("float16");
  std::string add, change, energy;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Energy& term = terms[i]->energy;
    const auto& name = term.equation.name;
    if (std::none_of(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(i),
                     [&](const Term* other) { return other->energy.equation.name == name; }))
      text += equation_source(term, "float16");
    text += fmt::format(
        "#undef NAME_RESIDUAL\n#undef NAME_JACOBIAN\n#undef TERM\n#undef RESIDUALS\n#undef ROBUST\n"
        "#define NAME_RESIDUAL {0}_residual\n#define NAME_JACOBIAN {0}_jacobian\n#define TERM(x) x##_{1}\n"
        "#define RESIDUALS {2}\n#define ROBUST {3}\n{4}{5}",
        name, i, term.residuals, static_cast<int>(term.loss.is_robust()), loss_choice_source(term.loss),
        embedded::solvers_gauss_newton_structured_node_terms_cl);
    add += fmt::format("  add_{}(u, inside * weights[{}], weights[{}], packed, gradient);\n", i, 2 * i,
                       2 * i + 1);
    change +=
        fmt::format("  change += change_{}(u, v, inside * weights[{}], weights[{}]);\n", i, 2 * i, 2 * i + 1);
    energy +=
        fmt::format("  energy += energy_{}(u, inside * weights[{}], weights[{}]);\n", i, 2 * i, 2 * i + 1);
  }
  return text + fmt::format(
                    "void add_node_terms(const float16* u, float16 inside, global const float* weights, "
                    "float16* packed,\n"
                    "                    float16* gradient) {{\n{}}}\n"
                    "float16 change_of_node_terms(const float16* u, const float16* v, float16 inside,\n"
                    "                             global const float* weights) {{\n"
                    "  float16 change = 0;\n{}  return change;\n}}\n"
                    "float16 energy_of_node_terms(const float16* u, float16 inside, global const float* "
                    "weights) {{\n"
                    "  float16 energy = 0;\n{}  return energy;\n}}\n",
                    add, change, energy);
}

}  // namespace

bool enters_matrix(const Energy& energy) {
  return energy.equation.axis_separable() && !energy.loss.is_robust();
}

std::string instance_terms_source(const Energy& energy) {
  const auto& name = energy.equation.name;
  return with_lanes(with_reductions(fmt::format(
      "{0}#define NAME_RESIDUAL {1}_residual\n#define NAME_JACOBIAN {1}_jacobian\n#define NAME_ROW {1}_row\n"
      "#define KERNEL(x) x##_{1}\n#define RESIDUALS {2}\n#define PER_EDGE {3}\n#define SEPARABLE {4}\n"
      "#define ROBUST {5}\n{6}{7}",
      equation_source(energy, "float16"), name, energy.residuals,
      static_cast<int>(energy.stencil == Stencil::per_edge), static_cast<int>(enters_matrix(energy)),
      static_cast<int>(energy.loss.is_robust()), loss_source(energy.loss, "float16"),
      embedded::solvers_gauss_newton_structured_instance_terms_cl)));
}

std::string minimiser_source(const std::vector<const Term*>& terms, int slots, bool coupled,
                             std::size_t group_size) {
  return with_lanes(
      with_reductions(fmt::format("#define SLOTS {}\n#define K {}\n#define COUPLED {}\n{}{}{}{}{}{}",
                                  max_influences, slots, static_cast<int>(coupled), node_terms_source(terms),
                                  embedded::solvers_gauss_newton_structured_layout_cl,
                                  embedded::solvers_gauss_newton_structured_packed_cl,
                                  embedded::solvers_gauss_newton_structured_assembly_cl,
                                  embedded::solvers_gauss_newton_structured_conjugate_gradients_cl,
                                  embedded::solvers_gauss_newton_structured_minimiser_cl),
                      group_size));
}

}  // namespace pliant
