#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace pliant {

/// Where a camera was, in the format of the TUM RGB-D benchmark: lines `TIME tx ty tz qx qy qz qw`, the
/// camera's place in metres and its orientation as a unit quaternion, in a frame that stays. The benchmark's
/// camera is the colour camera, to which its depth is registered.
class TumPoses {
 public:
  /// Reads a file. Throws DataError naming file and line where a line is none, a quaternion has not the
  /// length 1 to 1%, or time goes back; of poses at one time the last counts.
  explicit TumPoses(const std::string& path);

  /// From the camera's frame to the one that stays, mm, at a time in the file's seconds. Between the poses
  /// before and after, at most 100 ms apart, the place moves at constant speed and the camera turns at
  /// constant speed about one axis (slerp). None elsewhere.
  std::optional<Eigen::Isometry3d> at(double time) const;

 private:
  struct Pose {
    double time = 0;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  // mm
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  };

  std::vector<Pose> poses_;
};

}  // namespace pliant
