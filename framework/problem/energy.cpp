#include "framework/problem/energy.h"

#include <stdexcept>

namespace pliant {

const char* to_string(Stencil stencil) {
  switch (stencil) {
    case Stencil::per_node:
      return "per_node";
    case Stencil::per_edge:
      return "per_edge";
    case Stencil::per_constraint:
      return "per_constraint";
  }
  return "";
}

void add_energy(Registry& registry, const std::string& name, const std::string& doc, const Energy& energy) {
  if (energy.residuals < 1 || energy.residuals > max_residuals)
    throw std::logic_error("energy '" + name + "' has " + std::to_string(energy.residuals) + " residuals");
  registry.add<Energy>(
      name, doc, {real("weight", energy.weight).at_least(0).doc("Factor of this term in E_tot [Eq. 4.6]")},
      [energy](const Parameters& parameters, const Registry&) {
        auto made = std::make_unique<Energy>(energy);
        made->weight = parameters.real("weight");
        return made;
      });
}

}  // namespace pliant
