#include "experiments/tasks/pose_truth.h"

namespace pliant {

PoseError pose_error(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d between = found.inverse() * truth;  // of two cameras in the model's frame
  return {(found.inverse().translation() - truth.inverse().translation()).norm(),
          Eigen::AngleAxisd(between.rotation()).angle() * 180 / EIGEN_PI};
}

std::optional<PoseError> PoseTruth::error_of(const FrameRecord& record) {
  const auto world_from_camera = stream_.camera_pose(record.number);
  if (record.state == FrameState::started) world_from_model_ = world_from_camera;
  if (!world_from_camera || !world_from_model_) return {};
  return pose_error(record.camera_from_model, world_from_camera->inverse() * *world_from_model_);
}

}  // namespace pliant
