#pragma once

#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/deformation/graph_builder.h"
#include "framework/deformation/node_transform.h"
#include "framework/geometry/depth_filter.h"
#include "framework/problem/solver.h"
#include "framework/registration/alignment.h"
#include "framework/registration/correspondence.h"
#include "framework/registration/sampler.h"

namespace pliant {

/// When the outer loop of Figure 4.1 ends.
struct StoppingRule {
  int max_iterations = 30;
  double residual = 0;         ///< mm; ends when the mean residual is below
  double min_progress = 1e-3;  ///< ends when the mean residual falls by less than this share of itself
};

/// A stiff and tolerant start, relaxed stage by stage. What is stiff is not bent by matches that are far from
/// the truth, and a surface that is nearly in place finds better ones (Amberg et al. 2007); a wide loss takes
/// nothing for an outlier that is only far away yet (graduated non-convexity, Blake and Zisserman 1987).
struct Relaxation {
  int stages = 1;
  double stiffness = 1;   ///< factor in the first stage of the energies per node and per edge
  double loss_scale = 1;  ///< factor in the first stage of the scale of robust losses
  int iterations = 5;     ///< outer iterations at most in each stage but the last

  /// The term as it counts in a stage: the factors fall geometrically, to 1 in the last stage.
  Energy relaxed(Energy energy, int stage) const;
};

/// How a pair is registered: the components that an experiment file puts together.
struct Method {
  std::unique_ptr<DepthFilter> filter;
  std::unique_ptr<Alignment> alignment;
  std::unique_ptr<GraphBuilder> graph;
  std::unique_ptr<NodeTransform> transform;
  int nearest_nodes = 4;  ///< k of [Eq. 4.1]
  std::unique_ptr<ConstraintSampler> sampler;
  std::unique_ptr<Correspondence> correspondence;
  std::vector<Energy> energies;
  double length_unit = 1;  ///< mm per unit of length in the energies
  std::unique_ptr<Solver> solver;
  Relaxation relaxation;
  StoppingRule stopping;
};

/// Whether any of its energies rests on matched features and counts.
bool uses_features(const Method& method);

/// The rows of an experiment file that describe a method.
std::vector<Parameter> method_rows();

/// Assembles the method that an experiment describes. Throws ConfigError for a combination that makes no
/// sense.
Method make_method(const Parameters& experiment, const Registry& registry);

}  // namespace pliant
