#include "experiments/tasks/track_truth.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "framework/core/angle.h"
#include "framework/evaluation/mesh_distance.h"
#include "framework/geometry/bounding_box.h"

namespace pliant {

PoseError pose_error(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d between = found.inverse() * truth;  // of two cameras in the model's frame
  return {(found.inverse().translation() - truth.inverse().translation()).norm(),
          Eigen::AngleAxisd(between.rotation()).angle() / degree};
}

std::optional<PoseError> TrackTruth::error_of(const FrameRecord& record) {
  const auto world_from_camera = stream_.camera_pose(record.number);
  if (record.state == FrameState::started) world_from_model_ = world_from_camera;
  if (!world_from_camera || !world_from_model_) return {};
  return pose_error(record.camera_from_model, world_from_camera->inverse() * *world_from_model_);
}

std::optional<ModelError> TrackTruth::error_of(const Mesh& model, int number) const {
  const auto world_from_camera = stream_.camera_pose(number);
  if (!world_from_camera || !world_from_model_ || model.vertices.empty()) return {};
  const auto surface = stream_.surface(number);
  if (!surface) return {};
  const Eigen::Isometry3f camera_from_model =
      (world_from_camera->inverse() * *world_from_model_).cast<float>();
  std::vector<Eigen::Vector3f> vertices = model.vertices;
  for (Eigen::Vector3f& vertex : vertices) vertex = camera_from_model * vertex;
  // About as many samples whatever its size.
  const double spacing =
      std::max(5.0, static_cast<double>(box_around(surface->vertices).sizes().maxCoeff()) / 1000);
  std::vector<float> distances = MeshDistance(*surface, spacing).distances(vertices);
  const auto p95 =
      distances.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(distances.size()));
  std::nth_element(distances.begin(), p95, distances.end());
  return ModelError{
      std::accumulate(distances.begin(), distances.end(), 0.0) / static_cast<double>(distances.size()),
      static_cast<double>(*p95)};
}

}  // namespace pliant
