#include "framework/pose/head_forest.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

Eigen::Matrix3d facing_camera() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }

}  // namespace

const HeadLeaf& HeadTree::leaf_of(const DepthPatch& patch) const {
  int at = nodes.empty() ? -1 : 0;
  while (at >= 0) {
    const Node& node = nodes[static_cast<std::size_t>(at)];
    at = node.test.is_above(patch) ? node.above : node.below;
  }
  return leaves[static_cast<std::size_t>(~at)];
}

Eigen::Matrix3d head_rotation(const Eigen::Vector3d& angles) {
  return (Eigen::AngleAxisd(angles.x(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles.y(), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(angles.z(), Eigen::Vector3d::UnitZ()))
             .toRotationMatrix() *
         facing_camera();
}

Eigen::Vector3d head_angles(const Eigen::Matrix3d& camera_from_head) {
  const Eigen::Matrix3d turned = camera_from_head * facing_camera();
  return {std::atan2(turned(0, 2), turned(2, 2)), std::asin(std::clamp(-turned(1, 2), -1.0, 1.0)),
          std::atan2(turned(1, 0), turned(1, 1))};
}

Eigen::Isometry3d moved(const Eigen::Vector3d& offset, const Eigen::Vector3d& turn) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = offset;
  const double angle = turn.norm();
  if (angle > 0) motion.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  return motion;
}

}  // namespace pliant
