#include <cmath>

#include "framework/pose/focal_length.h"
#include "framework/pose/focal_length_equation.h"
#include "framework/pose/projective_icp.h"
#include "framework/pose/rigid_equation.h"

namespace pliant {

FocalLengthEquations focal_length_equations_reference(const SurfaceMap& first, const SurfaceMap& view,
                                                      const Eigen::Isometry3d& view_from_first,
                                                      const Eigen::Vector3d& pivot) {
  const ProjectiveIcpLevel limits = focal_length_limits(first.window);
  FocalLengthEquations equations;
  equations.motion.pivot = pivot;
  for (std::size_t pixel = 0; pixel < first.window.size(); ++pixel) {
    const Eigen::Vector3d p = finite_or_none(first.points(), pixel).cast<double>();
    const Eigen::Vector3d before = finite_or_none(first.normals(), pixel).cast<double>();
    if (!(p.z() > 0) || before.isZero(0)) continue;
    const Eigen::Vector3d moved = view_from_first * p;
    const auto landed = pixel_reference(view.camera, moved.cast<float>());
    if (!landed) continue;
    const Eigen::Vector3d q = finite_or_none(view, view.points(), *landed).cast<double>();
    const Eigen::Vector3d n = finite_or_none(view, view.normals(), *landed).cast<double>();
    const Eigen::Vector3d own = view_from_first.linear() * before;
    const Eigen::Vector3d away = moved - q;
    if (!(q.z() > 0) || away.norm() > limits.farthest(q.z()) || own.dot(n) < std::cos(limits.max_angle))
      continue;
    const Eigen::Vector3d lever = q - pivot;
    Eigen::Matrix<double, 6, 1> J;
    plane_distance_jacobian(lever.data(), own.data(), J.data());
    const double r = plane_distance(away.data(), own.data());
    const double stretch = plane_distance_by_focal_length(p.data(), before.data(), moved.data(), own.data());
    equations.motion.JtJ += J * J.transpose();
    equations.motion.Jtr += J * r;
    equations.motion.squares += r * r;
    ++equations.motion.matches;
    equations.mixed += J * stretch;
    equations.curvature += stretch * stretch;
    equations.gradient += stretch * r;
  }
  return equations;
}

}  // namespace pliant
