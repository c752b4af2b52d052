#pragma once

#include <functional>
#include <memory>
#include <string>

#include "framework/registration/matched_problem.h"
#include "framework/registration/nonrigid_result.h"

namespace pliant {

/// A look at non-rigid registration after an outer iteration. What is on the device is copied only when it is
/// read, and valid only during the call.
struct IterationView {
  int number;    ///< 1 for the first; of the one before, with its `measured`, where an iteration failed
  bool is_last;  ///< whether the loop has ended
  const NonRigidResult::Step& measured;
  const EmbeddedGraph& graph;
  const Constraints& constraints;
  const PointSet& points;         ///< those that are followed, where they are now: mm, camera frame
  const Array<float>& residuals;  ///< of these, mm; -1 where a point has no match that is accepted
  const PointSet& rest;           ///< all points of the source at rest
  const Array<float>& unknowns;   ///< where they are now: warp() takes both with what the graph has
};

/// Called after each outer iteration. What it throws ends the registration and comes through.
using Observer = std::function<void(const IterationView&)>;

/// Where the last iteration of non-rigid registration led, be it the best or not; all on the device.
struct Deformation {
  std::shared_ptr<const EmbeddedGraph> graph;
  Array<float> affine;  ///< its transforms, affine_size numbers a node (see warp.h)
  PointSet points;      ///< all points of the source, deformed
  int iterations = 0;
  int constraints = 0;
  /// Of NonRigidResult.
  std::string termination = {}, reason = {};
};

/// Non-rigid registration [thesis Figure 4.1], bound to a method and a device; both must outlive it. Runs on
/// any number of frames, one after another; what one run throws leaves it fit for the next.
class NonRigid {
 public:
  NonRigid(const NonRigidMethod& method, Device& device);

  /// The same input, method and device give the same bits. Throws DataError when the input or the graph gives
  /// too little to begin with, NumericalError when the source is not finite. What goes wrong later ends the
  /// loop: the result is then that of the best one before, and `termination` and `reason` say why.
  NonRigidResult run(const NonRigidInput& input, const Observer& observer = {}) const;

  /// Without a copy to the host, and without a choice among the iterations: who follows a surface judges by
  /// more than one matching.
  Deformation deform(const NonRigidInput& input) const;

  /// The problem of the first outer iteration: graph built, constraints matched once, nothing solved. Solvers
  /// can be compared on it.
  std::unique_ptr<Problem> freeze(const NonRigidInput& input) const;

 private:
  const NonRigidMethod& method_;
  Device& device_;
};

}  // namespace pliant
