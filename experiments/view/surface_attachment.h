#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

namespace pliant {

/// Binds something to a part of a deforming surface, of which some points are followed.
class SurfaceAttachment {
 public:
  /// `points`: where they are now, mm. Those within `reach` (mm) of the anchor carry it, up to `most` nearest
  /// ones.
  SurfaceAttachment(const std::vector<Eigen::Vector3f>& points, const Eigen::Vector3d& anchor, double reach);

  /// How that part has moved since: the rigid motion of least squares [Kabsch 1976], in the frame of the
  /// points, mm. Where fewer than three points carry it, or all lie on a line, it shifts and does not turn;
  /// without any it stays. `points`: the same as before, in the same order.
  Eigen::Isometry3d motion(const std::vector<Eigen::Vector3f>& points) const;

  static constexpr std::size_t most = 64;

 private:
  Eigen::Matrix3Xd places_of(const std::vector<Eigen::Vector3f>& points) const;

  std::vector<std::size_t> carriers_;  // of the points
  Eigen::Matrix3Xd rest_;              // where they were
  bool can_turn_ = false;
};

}  // namespace pliant
