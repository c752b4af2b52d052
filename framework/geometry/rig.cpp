#include "framework/geometry/rig.h"

#include <fmt/format.h>

#include <cmath>

#include "framework/core/error.h"

namespace pliant {
namespace {

void check(const Camera& camera, const std::string& name, const char* which) {
  if (!std::isfinite(camera.fx) || !std::isfinite(camera.fy) || camera.fx <= 0 || camera.fy <= 0)
    throw DataError(
        fmt::format("{}: {}'s focal lengths are {} and {} pixels; expected finite positive numbers", name,
                    which, camera.fx, camera.fy));
  if (!std::isfinite(camera.cx) || !std::isfinite(camera.cy))
    throw DataError(fmt::format("{}: {}'s principal point is ({}, {}); expected finite numbers", name, which,
                                camera.cx, camera.cy));
}

}  // namespace

bool is_rigid(const Eigen::Matrix4d& matrix) {
  constexpr double tolerance = 1e-3;
  if (!matrix.allFinite() || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) return false;
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const Eigen::Matrix3d off = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  return off.cwiseAbs().maxCoeff() <= tolerance && rotation.determinant() > 0;
}

void check(const Rig& rig, const std::string& name) {
  check(rig.depth, name, "the camera");
  if (!rig.color) return;
  check(*rig.color, name, "the colour camera");
  if (!is_rigid(rig.color_from_depth.matrix()))
    throw DataError(fmt::format(
        "{}: the motion from the depth camera to the colour camera is not rigid; expected a rotation and a "
        "translation in mm",
        name));
}

}  // namespace pliant
