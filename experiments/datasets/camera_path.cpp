#include "experiments/datasets/camera_path.h"

#include <fmt/format.h>

#include "framework/core/angle.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

const Eigen::Vector3d down = Eigen::Vector3d::UnitY();

Eigen::Vector3d vector_of(const Parameters& section, const char* name) {
  return Eigen::Map<const Eigen::Vector3d>(section.reals(name).data());
}

/// The sine of the angle between a line of sight and straight down.
double sine_to_down(const Eigen::Vector3d& sight) { return down.cross(sight.normalized()).norm(); }

Eigen::Quaterniond looking_along(const Eigen::Vector3d& sight) {
  Eigen::Matrix3d axes;
  axes.col(2) = sight.normalized();
  axes.col(0) = down.cross(axes.col(2)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return Eigen::Quaterniond(axes);
}

/// Whether a section says anything of what its rows have.
bool is_given(const Parameters& section, const char* name) {
  return section.has(name) && !vector_of(section, name).isZero(0);
}

}  // namespace

Eigen::Quaterniond turned(const Eigen::Vector3d& degrees) {
  const Eigen::Vector3d radians = degrees * degree;
  return Eigen::AngleAxisd(radians.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(radians.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(radians.x(), Eigen::Vector3d::UnitX());
}

Eigen::Isometry3d CameraPose::camera_from_scene() const {
  Eigen::Isometry3d scene_from_camera = Eigen::Isometry3d::Identity();
  scene_from_camera.translate(position);
  scene_from_camera.rotate(look_at ? looking_along(*look_at - position) : orientation);
  return scene_from_camera.inverse();
}

ParameterTable camera_pose_table() {
  return {
      reals("look_from", 3)
          .unit("mm")
          .optional()
          .doc("where the camera stands, in the frame of the first camera (x right, y down, z forward)"),
      reals("look_at", 3)
          .unit("mm")
          .optional()
          .doc("the point in the middle of its image, its x axis level; the middle of the mesh by default"),
      reals("shift", 3, std::vector<double>{0, 0, 0})
          .unit("mm")
          .doc("instead of looking: where the camera stands"),
      reals("rotation", 3, std::vector<double>{0, 0, 0})
          .unit("degree")
          .doc("instead of looking: how it is turned about x, then y, then z"),
  };
}

CameraPose read_camera_pose(const Parameters& section, const Eigen::Vector3d& middle) {
  const bool looks = section.has("look_from") || section.has("look_at");
  if (!looks) return {vector_of(section, "shift"), turned(vector_of(section, "rotation"))};
  if (is_given(section, "shift") || is_given(section, "rotation"))
    throw ConfigError(fmt::format(
        "{}: 'camera' both looks and is shifted or rotated; expected look_from and look_at, or shift and "
        "rotation",
        section.place()));
  CameraPose pose;
  if (section.has("look_from")) pose.position = vector_of(section, "look_from");
  pose.look_at = section.has("look_at") ? vector_of(section, "look_at") : middle;
  const Eigen::Vector3d sight = *pose.look_at - pose.position;
  if (!(sight.norm() > 0) || sine_to_down(sight) < 1e-3)
    throw ConfigError(
        fmt::format("{}: 'camera' looks {}; expected a look_at that is not above, below or at look_from",
                    section.place(), sight.norm() > 0 ? "straight up or down" : "at where it stands"));
  return pose;
}

CameraPose between(const CameraPose& from, const CameraPose& to, double share) {
  CameraPose pose;
  pose.position = from.position + share * (to.position - from.position);
  if (from.look_at && to.look_at) {
    pose.look_at = *from.look_at + share * (*to.look_at - *from.look_at);
    return pose;
  }
  const auto orientation_of = [](const CameraPose& end) {
    return Eigen::Quaterniond(end.camera_from_scene().rotation().transpose());
  };
  pose.orientation = orientation_of(from).slerp(share, orientation_of(to));
  return pose;
}

}  // namespace pliant
