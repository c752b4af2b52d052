#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/deformation/graph_builder.h"
#include "framework/deformation/node_transform.h"
#include "framework/problem/solver.h"
#include "framework/registration/correspondence.h"
#include "framework/registration/sampler.h"

namespace pliant {

/// When the outer loop of Figure 4.1 ends.
struct StoppingRule {
  int max_iterations = 30;
  double residual = 0;         ///< mm; ends when the mean residual is below
  double min_progress = 1e-3;  ///< ends when the mean residual falls by less than this share of itself
  /// mm; of the robust residual (Residual::robust), by which the iteration is chosen that is returned.
  double cut = 5;
  double min_gain = 0;  ///< share by which that must be less than at the alignment, else this is returned
};

/// How weights and scales of losses go from their initial values to the final ones. What is stiff at first is
/// not bent by matches that are far from the truth (Amberg et al. 2007); a wide loss takes nothing for an
/// outlier that is only far away yet (graduated non-convexity, Blake and Zisserman 1987).
struct Schedule {
  int iterations = 0;  ///< outer iterations until the final values are reached

  /// How much lies ahead before an outer iteration: 1 before the first, 0 from the end on.
  double remaining(int iteration) const {
    return iteration < iterations ? 1 - static_cast<double>(iteration) / iterations : 0;
  }
};

/// How a source is deformed onto a target: the components of the loop of Figure 4.1.
struct NonRigidMethod {
  std::unique_ptr<GraphBuilder> graph;
  std::unique_ptr<NodeTransform> transform;
  int nearest_nodes = 4;  ///< k of [Eq. 4.1]
  std::unique_ptr<ConstraintSampler> sampler;
  std::unique_ptr<Correspondence> correspondence;
  std::vector<Energy> energies;
  double length_unit = 1;  ///< mm per unit of length in the energies
  /// mm; depth noise (standard deviation) of the target up to which matches count in full. Beyond it energies
  /// of matches weigh by the inverse of its variance, as in any least squares: what holds the surface
  /// together stays. Infinite: they always count in full.
  double trusted_noise = std::numeric_limits<double>::infinity();
  std::unique_ptr<Solver> solver;
  Schedule schedule;
  StoppingRule stopping;
};

/// Whether any of its energies rests on matched features and counts.
bool uses_features(const NonRigidMethod& method);

/// The rows of an experiment file that describe such a method.
std::vector<Parameter> nonrigid_rows();

/// Assembles the method that an experiment describes. Throws ConfigError for a combination that makes no
/// sense.
NonRigidMethod make_nonrigid_method(const Parameters& experiment, const Registry& registry);

}  // namespace pliant
