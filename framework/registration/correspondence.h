#pragma once

#include "framework/core/registry.h"
#include "framework/deformation/warp.h"
#include "framework/device/array.h"
#include "framework/geometry/surface_map.h"
#include "framework/problem/problem.h"

namespace pliant {

/// Finds where each constrained point should go [thesis 4.2].
class Correspondence {
 public:
  static constexpr const char* kind = "correspondence";
  virtual ~Correspondence() = default;
  /// Writes `data` and `confidence` of every constraint; only enqueues. `selected[i]` is the point of
  /// `moved` (the source as it is deformed now) that constraint i stands for. A point without a match gets
  /// confidence 0.
  virtual void match(Device& device, const PointSet& moved, const Array<int>& selected,
                     const SurfaceMap& target, Constraints& constraints) const = 0;
  /// Writes how far each point of `moved` lies from the match that is accepted for it, in mm; -1 where none
  /// is. Only enqueues. What graph, sampler and stopping judge by: E_con of [Alg. 2, 3].
  virtual void measure(Device& device, const PointSet& moved, const SurfaceMap& target,
                       Array<float>& distances) const = 0;
  /// Whether `measure` accepts just the matches that `match` finds: then a residual tells what is matched.
  virtual bool measures_matches() const = 0;
};

/// Whether any of the constraints has a confidence above 0. Waits for everything enqueued so far.
bool any_in_force(Device& device, const Constraints& constraints);

/// Multiplies the confidence of each constraint by its weight; only enqueues.
void weigh(Device& device, const Array<float>& weights, Constraints& constraints);

/// Adds `projective` and `closest`.
void register_correspondences(Registry& registry);

}  // namespace pliant
