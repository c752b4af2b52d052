#pragma once

#include <string>

#include "framework/geometry/trajectory.h"

namespace pliant {

/// A pose as a line of the TUM RGB-D benchmark's trajectories: the time (s), the camera's place (m) and its
/// orientation as a unit quaternion x y z w, all in the frame that stays; ends with a line feed.
std::string trajectory_line(const TimedPose& pose);

/// Writes a trajectory so, a pose a line, behind a comment that names the columns. Throws DataError naming
/// the file.
void write_trajectory(const std::string& path, const Trajectory& trajectory);

/// Reads such a file. Throws DataError naming the file, the line and what was expected where there is no
/// pose, a time is not later than that of the line before, or a quaternion's length is off 1 by more than
/// a hundredth.
Trajectory read_trajectory(const std::string& path);

}  // namespace pliant
