#include "framework/registration/nonrigid_method.h"

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
      real("cut", rule.cut)
          .unit("mm")
          .above(0)
          .doc("The iteration is returned whose residuals, one above this or of a point without a match "
               "counting as this, have the least mean square; the alignment itself if none is better"),
      real("min_gain", rule.min_gain)
          .range(0, 1)
          .doc("Share by which the root of that must be less than at the alignment: what gains less explains "
               "nothing that noise does not, and the alignment is returned"),
  };
}

StoppingRule make_stopping(const Parameters& section) {
  return {static_cast<int>(section.integer("max_iterations")), section.real("residual"),
          section.real("min_progress"), section.real("cut"), section.real("min_gain")};
}

ParameterTable schedule_table() {
  return {integer("iterations", Schedule().iterations)
              .range(0, 10000)
              .doc("Outer iterations over which weights and loss scales of energies go from their initial "
                   "values to the final ones, geometrically")};
}

}  // namespace

bool uses_features(const NonRigidMethod& method) {
  return std::any_of(method.energies.begin(), method.energies.end(),
                     [](const Energy& energy) { return energy.uses_features() && energy.weight > 0; });
}

std::vector<Parameter> nonrigid_rows() {
  const NonRigidMethod method;
  return {
      component("graph", "graph", "uniform").doc("Where the nodes of the deformation graph are"),
      component("transform", "transform", "affine").doc("What a node carries"),
      integer("nearest_nodes", method.nearest_nodes)
          .range(1, max_influences)
          .doc("Nodes that move a point: k of [Eq. 4.1]"),
      component("sampler", "sampler", "uniform").doc("Which points are constrained"),
      component("correspondence", "correspondence", "projective").doc("Where constrained points should go"),
      components("energies", "energy")
          .optional()
          .by_default({"rotation", "regularization", "constraint"})
          .doc("Terms of E_tot [Eq. 4.6]"),
      real("length_unit", method.length_unit)
          .unit("mm")
          .above(0)
          .doc("Unit of length in the energies: 1000 for metres; it shifts the balance of their weights"),
      real("trusted_noise")
          .unit("mm")
          .above(0)
          .optional()
          .doc("Noise of the target's depth up to which energies of matches count in full; beyond it they "
               "weigh "
               "by (trusted_noise / noise)^2; not given: always in full"),
      component("solver", "solver", "gauss_newton").doc("What minimises E_tot"),
      group("schedule", schedule_table()).doc("A stiff and tolerant start, if energies have initial values"),
      group("stopping", stopping_table()).doc("When the outer loop ends"),
  };
}

NonRigidMethod make_nonrigid_method(const Parameters& experiment, const Registry& registry) {
  NonRigidMethod method;
  method.graph = registry.make<GraphBuilder>(experiment.section("graph"));
  method.transform = registry.make<NodeTransform>(experiment.section("transform"));
  method.nearest_nodes = static_cast<int>(experiment.integer("nearest_nodes"));
  method.sampler = registry.make<ConstraintSampler>(experiment.section("sampler"));
  method.correspondence = registry.make<Correspondence>(experiment.section("correspondence"));
  for (const auto& [name, section] : experiment.sections("energies"))
    method.energies.push_back(*registry.make<Energy>(section));
  method.length_unit = experiment.real("length_unit");
  if (experiment.has("trusted_noise")) method.trusted_noise = experiment.real("trusted_noise");
  method.solver = registry.make<Solver>(experiment.section("solver"));
  method.schedule = {static_cast<int>(experiment.section("schedule").integer("iterations"))};
  method.stopping = make_stopping(experiment.section("stopping"));
  return method;
}

}  // namespace pliant
