#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/deformation/embedded_graph.h"
#include "framework/geometry/point_matches.h"
#include "framework/geometry/point_selection.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"
#include "framework/geometry/surface_map.h"
#include "framework/registration/nonrigid_method.h"

namespace pliant {

/// What non-rigid registration begins with; all of it in one camera frame, and all of it stays as it is.
struct NonRigidInput {
  const std::string& name;   ///< for messages
  const Surface& source;     ///< at rest; its pixels are those of the target's camera
  const PointSet& rest;      ///< the same on the device
  const SurfaceMap& target;  ///< filtered
  double noise;              ///< of the target's depth before that: standard deviation, mm
  /// Points at rest and where features say that they are in the target; empty without features.
  const PointMatches& features;
};

/// A problem whose constraints are matched anew before each solve.
struct MatchedProblem {
  Array<int> selected;   ///< the points that are constrained, among those that are followed
  Array<float> weights;  ///< of these; empty: all the same
  std::shared_ptr<Constraints> constraints;
  std::unique_ptr<Problem> problem;
};

/// Whether an energy becomes a term of the problem: one that never counts would only be evaluated in vain.
bool applies(const NonRigidMethod& method, const Energy& energy);

/// `follows_all`: whether all points of the source are followed, or the selected ones alone. Throws DataError
/// when none is selected.
MatchedProblem make_matched_problem(Device& device, const NonRigidMethod& method, const NonRigidInput& input,
                                    const EmbeddedGraph& graph, const PointSelection& selection,
                                    bool follows_all);

}  // namespace pliant
