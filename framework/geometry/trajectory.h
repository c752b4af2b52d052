#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace pliant {

/// Where a camera was at a moment.
struct TimedPose {
  double time = 0;                                         ///< seconds
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< from the camera's frame to one that stays, mm
};

/// In order of time.
using Trajectory = std::vector<TimedPose>;

}  // namespace pliant
