#include "framework/registration/method.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

ParameterTable stopping_table() {
  const StoppingRule rule;
  return {
      integer("max_iterations", rule.max_iterations)
          .range(1, 10000)
          .doc("Outer iterations (match, minimise, update) at most"),
      real("residual", rule.residual)
          .unit("mm")
          .at_least(0)
          .doc("Ends when the mean residual of accepted matches is below"),
      real("min_progress", rule.min_progress)
          .range(0, 1)
          .doc("Ends when that residual falls by less than this share of itself"),
  };
}

StoppingRule make_stopping(const Parameters& section) {
  return {static_cast<int>(section.integer("max_iterations")), section.real("residual"),
          section.real("min_progress")};
}

ParameterTable relaxation_table() {
  const Relaxation relaxation;
  return {
      integer("stages", relaxation.stages)
          .range(1, 100)
          .doc("Stages from a stiff start to none; 1: no relaxation"),
      real("stiffness", relaxation.stiffness)
          .above(0)
          .doc(
              "Factor of the energies per node and per edge in the first stage; it falls geometrically to 1"),
      real("loss_scale", relaxation.loss_scale)
          .above(0)
          .doc("Factor of the scale of robust losses in the first stage; it falls geometrically to 1"),
      integer("iterations", relaxation.iterations)
          .range(1, 10000)
          .doc("Outer iterations of a stage at most, but for the last; no progress ends it sooner"),
  };
}

Relaxation make_relaxation(const Parameters& section) {
  return {static_cast<int>(section.integer("stages")), section.real("stiffness"), section.real("loss_scale"),
          static_cast<int>(section.integer("iterations"))};
}

}  // namespace

Energy Relaxation::relaxed(Energy energy, int stage) const {
  const double remaining = stages < 2 ? 0 : static_cast<double>(stages - 1 - stage) / (stages - 1);
  if (energy.stencil == Stencil::per_constraint)
    energy.loss.scale *= std::pow(loss_scale, remaining);
  else
    energy.weight *= std::pow(stiffness, remaining);
  return energy;
}

bool uses_features(const Method& method) {
  return std::any_of(method.energies.begin(), method.energies.end(),
                     [](const Energy& energy) { return energy.uses_features() && energy.weight > 0; });
}

std::vector<Parameter> method_rows() {
  const Method method;
  return {
      component("filter", "filter", "none").doc("Noise reduction of both depth images before registration"),
      component("alignment", "alignment", "none").doc("Rigid motion from which registration starts"),
      component("graph", "graph", "uniform").doc("Where the nodes of the deformation graph are"),
      component("transform", "transform", "affine").doc("What a node carries"),
      integer("nearest_nodes", method.nearest_nodes)
          .range(1, max_influences)
          .doc("Nodes that move a point: k of [Eq. 4.1]"),
      component("sampler", "sampler", "uniform").doc("Which points are constrained"),
      component("correspondence", "correspondence", "projective").doc("Where constrained points should go"),
      components("energies", "energy").doc("Terms of E_tot [Eq. 4.6]"),
      real("length_unit", method.length_unit)
          .unit("mm")
          .above(0)
          .doc("Unit of length in the energies: 1000 for metres; it shifts the balance of their weights"),
      component("solver", "solver", "gauss_newton").doc("What minimises E_tot"),
      group("relaxation", relaxation_table())
          .doc("A stiff and tolerant start that is relaxed stage by stage"),
      group("stopping", stopping_table()).doc("When the outer loop ends"),
  };
}

Method make_method(const Parameters& experiment, const Registry& registry) {
  Method method;
  method.filter = registry.make<DepthFilter>(experiment.section("filter"));
  method.alignment = registry.make<Alignment>(experiment.section("alignment"));
  method.graph = registry.make<GraphBuilder>(experiment.section("graph"));
  method.transform = registry.make<NodeTransform>(experiment.section("transform"));
  method.nearest_nodes = static_cast<int>(experiment.integer("nearest_nodes"));
  method.sampler = registry.make<ConstraintSampler>(experiment.section("sampler"));
  method.correspondence = registry.make<Correspondence>(experiment.section("correspondence"));
  for (const auto& [name, section] : experiment.sections("energies"))
    method.energies.push_back(*registry.make<Energy>(section));
  method.length_unit = experiment.real("length_unit");
  method.solver = registry.make<Solver>(experiment.section("solver"));
  method.relaxation = make_relaxation(experiment.section("relaxation"));
  method.stopping = make_stopping(experiment.section("stopping"));
  return method;
}

}  // namespace pliant
