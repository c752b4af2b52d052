#include "experiments/datasets/rigid_motion.h"

#include "framework/core/angle.h"

namespace pliant {

Eigen::Isometry3d RigidMotion::transform() const {
  return Eigen::Translation3d(shift) * Eigen::AngleAxisd(rotation_x * degree, Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(rotation_y * degree, Eigen::Vector3d::UnitY());
}

ParameterTable motion_table() {
  return {
      real("rotation_x", 0).unit("degree").range(-180, 180).doc("about the camera's x axis, a nod"),
      real("rotation_y", 0).unit("degree").range(-180, 180).doc("about its y axis, before, a shake"),
      real("shift_x", 0).unit("mm").doc("to the right in the image"),
      real("shift_y", 0).unit("mm").doc("down in the image"),
      real("shift_z", 0).unit("mm").doc("away from the camera"),
  };
}

RigidMotion read_motion(const Parameters& section) {
  return {section.real("rotation_x"),
          section.real("rotation_y"),
          {section.real("shift_x"), section.real("shift_y"), section.real("shift_z")}};
}

RigidMotion between(const RigidMotion& from, const RigidMotion& to, double share) {
  return {from.rotation_x + share * (to.rotation_x - from.rotation_x),
          from.rotation_y + share * (to.rotation_y - from.rotation_y),
          from.shift + share * (to.shift - from.shift)};
}

}  // namespace pliant
