#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/deformation/embedded_graph.h"
#include "framework/geometry/pixel_index.h"
#include "framework/geometry/point_matches.h"
#include "framework/geometry/point_selection.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface_map.h"
#include "framework/registration/nonrigid_method.h"

namespace pliant {

/// A graph that registration uses instead of the one that its method would build.
struct GivenGraph {
  std::vector<int>
      nodes;            ///< points of the source, ascending; those that no pixel shows are moved, not matched
  Array<float> affine;  ///< where they start: affine_size numbers each (see warp.h)
};

/// What non-rigid registration begins with; all of it in one camera frame, and all of it stays as it is.
struct NonRigidInput {
  const std::string& name;   ///< for messages
  const PixelIndex& pixels;  ///< of the source: those of the target's camera
  const PointSet& rest;      ///< the source at rest
  const SurfaceMap& target;  ///< filtered
  double noise;              ///< of the target's depth before that: standard deviation, mm
  /// Points at rest and where features say that they are in the target; empty without features.
  const PointMatches& features;
  const GivenGraph* graph = nullptr;  ///< null: that of the method, from the identity
};

/// The constraints of a problem, which are matched anew before each solve.
struct MatchedConstraints {
  std::vector<int> points;  ///< of the source, ascending
  Array<int> selected;      ///< the same among those that are followed
  Array<float> weights;     ///< of these; empty: all the same
  PointSet rest;            ///< these points
  std::shared_ptr<Constraints> constraints;
};

/// Constraints at some points (x y z each, mm) that matching will write; without influences.
Constraints unmatched_at(Array<float> points);

/// 0, 1, 2, ...
Array<int> first_indices(std::size_t count);

/// Whether an energy becomes a term of the problem: one that never counts would only be evaluated in vain.
bool applies(const NonRigidMethod& method, const Energy& energy);

/// Constraints without influences yet: matching, which needs none, may begin. `follows_all`: whether all
/// points of the source are followed, or the selected ones alone. Throws DataError when none is selected.
MatchedConstraints make_constraints(Device& device, const NonRigidInput& input,
                                    const PointSelection& selection, bool follows_all);

/// Hangs the constraints on the graph, which has its edges, and makes the problem of them.
std::unique_ptr<Problem> make_problem(Device& device, const NonRigidMethod& method,
                                      const PointMatches& features, const EmbeddedGraph& graph,
                                      const MatchedConstraints& matched);

}  // namespace pliant
