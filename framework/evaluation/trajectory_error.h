#pragma once

#include "framework/geometry/trajectory.h"

namespace pliant {

/// Root mean squares over the poses, or pairs of poses, that were compared.
struct TrajectoryError {
  double translation = 0;  ///< mm
  double rotation = 0;     ///< degrees
  int count = 0;
};

/// What makes the frames of reference of two trajectories one.
enum class TrajectoryAlignment {
  rigid,  ///< places by the rigid motion, orientations by the rotation that brings them nearest
  first,  ///< the first pose that both have
};

/// How far an estimate is from the truth, pose by pose [absolute trajectory error; Sturm, Engelhard, Endres,
/// Burgard, Cremers 2012]. Poses belong together whose times are nearest and at most `apart` seconds from
/// each other. Throws DataError when none do.
TrajectoryError absolute_error(const Trajectory& estimate, const Trajectory& truth,
                               TrajectoryAlignment alignment, double apart = 0.01);

/// The same of the motion from each pose to the one that is `step` poses later among those that belong
/// together [relative pose error]: drift. Throws DataError also when there is no such pair.
TrajectoryError relative_error(const Trajectory& estimate, const Trajectory& truth, int step = 1,
                               double apart = 0.01);

}  // namespace pliant
