#include "framework/problem/energy.h"

#include <ceres/jet.h>

#include <cmath>
#include <stdexcept>

#include "framework/problem/loss.h"

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

namespace {

/// Calls `apply` with the functions of a loss over `Real`.
template <class Real, class Apply>
Real with_loss(const std::string& name, Apply apply) {
  if (name == "none") return apply(none_value<Real>, none_weight<Real>);
  if (name == "huber") return apply(huber_value<Real>, huber_weight<Real>);
  if (name == "tukey") return apply(tukey_value<Real>, tukey_weight<Real>);
  if (name == "welsch") return apply(welsch_value<Real>, welsch_weight<Real>);
  throw std::logic_error("there is no loss '" + name + "'");
}

ParameterTable energy_table(const Energy& energy) {
  std::vector<Parameter> rows{
      real("weight", energy.weight).at_least(0).doc("Factor of this term in E_tot [Eq. 4.6]"),
      real("initial_weight")
          .above(0)
          .optional()
          .doc("The same in the first outer iteration; `schedule` leads from there to `weight`")};
  if (energy.takes_loss()) {
    rows.push_back(choice("loss", loss_names(), energy.loss.name)
                       .doc("Robust loss of the squared residual; none: the square itself"));
    rows.push_back(real("loss_scale", energy.loss.scale)
                       .unit("mm")
                       .above(0)
                       .doc("Residual at which the loss begins to take it for an outlier"));
    rows.push_back(
        real("initial_loss_scale")
            .unit("mm")
            .above(0)
            .optional()
            .doc("The same in the first outer iteration; `schedule` leads from there to `loss_scale`"));
  }
  return ParameterTable(std::move(rows));
}

std::optional<double> optional_real(const Parameters& parameters, const std::string& name) {
  if (!parameters.has(name)) return std::nullopt;
  return parameters.real(name);
}

double between(std::optional<double> initial, double final, double remaining) {
  return initial && final > 0 ? final * std::pow(*initial / final, remaining) : final;
}

}  // namespace

const std::vector<std::string>& loss_names() {
  static const std::vector<std::string> names{"none", "huber", "tukey", "welsch"};
  return names;
}

Energy Energy::at(double remaining) const {
  Energy energy = *this;
  energy.weight = between(initial_weight, weight, remaining);
  energy.loss.scale = between(initial_loss_scale, loss.scale, remaining);
  return energy;
}

double Loss::value(double s) const {
  return with_loss<double>(name, [&](auto value, auto) { return value(s, scale); });
}
double Loss::weight(double s) const {
  return with_loss<double>(name, [&](auto, auto weight) { return weight(s, scale); });
}
double Loss::curvature(double s) const {
  using Jet = ceres::Jet<double, 1>;
  return with_loss<Jet>(name, [&](auto, auto weight) { return weight(Jet(s, 0), Jet(scale)); }).v[0];
}

void add_energy(Registry& registry, const std::string& name, const std::string& doc, const Energy& energy) {
  if (energy.residuals < 1 || energy.residuals > max_residuals)
    throw std::logic_error("energy '" + name + "' has " + std::to_string(energy.residuals) + " residuals");
  registry.add<Energy>(name, doc, energy_table(energy),
                       [energy](const Parameters& parameters, const Registry&) {
                         auto made = std::make_unique<Energy>(energy);
                         made->weight = parameters.real("weight");
                         made->initial_weight = optional_real(parameters, "initial_weight");
                         if (!energy.takes_loss()) return made;
                         made->loss = {parameters.text("loss"), parameters.real("loss_scale")};
                         made->initial_loss_scale = optional_real(parameters, "initial_loss_scale");
                         return made;
                       });
}

}  // namespace pliant
