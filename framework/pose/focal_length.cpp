#include "framework/pose/focal_length.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <string>

#include "framework/core/angle.h"
#include "framework/pose/focal_length.cl.embed.h"
#include "framework/pose/focal_length_equation.h.embed.h"
#include "framework/pose/projective_icp.cl.embed.h"
#include "framework/pose/projective_icp.h"
#include "framework/problem/equation_source.h"

namespace pliant {
namespace {

constexpr std::size_t focal_sums = 40;  // FOCAL_SUMS in focal_length.cl

cl::Kernel focal_kernel(Device& device) {
  const auto text = [](int width) {
    const std::string equation =
        as_opencl(embedded::framework_pose_focal_length_equation_h, width == 1 ? "float" : "float16");
    return with_rigid_step(width, std::string(embedded::framework_pose_projective_icp_cl) + equation +
                                      std::string(embedded::framework_pose_focal_length_cl));
  };
  static const std::string scalar = text(1);
  static const std::string vector = text(16);
  return device.kernel(device.width() == 1 ? scalar : vector, "add_focal_length");
}

/// Curvature and gradient where each focal length has the motion that suits it best.
Eigen::Vector2d without_motion(const FocalLengthEquations& equations) {
  constexpr double damping = 1e-5;  // of the mean diagonal: directions that nothing tells
  constexpr double lever = 100;     // mm: turns are made as large as shifts
  Eigen::Matrix<double, 6, 1> unit = Eigen::Matrix<double, 6, 1>::Ones();
  unit.head<3>().setConstant(1 / lever);
  Eigen::Matrix<double, 6, 6> A = unit.asDiagonal() * equations.motion.JtJ * unit.asDiagonal();
  A.diagonal().array() += damping * A.trace() / 6;
  const Eigen::Matrix<double, 6, 1> mixed = unit.cwiseProduct(equations.mixed);
  const Eigen::Matrix<double, 6, 1> best = A.ldlt().solve(mixed);
  return {equations.curvature - best.dot(mixed),
          equations.gradient - best.dot(unit.cwiseProduct(equations.motion.Jtr))};
}

}  // namespace

ProjectiveIcpLevel focal_length_limits(const PixelWindow& window) {
  constexpr double noise = 6;  // far away; near by it is the 10 mm of ICP, or a nose would match a cheek
  return levels_of({.noise = noise}, window).back();
}

bool FocalLengthEstimate::is_wrong() const {
  constexpr int fewest = 5;
  constexpr double least_change = 0.05;
  constexpr double errors = 3;
  return views >= fewest && std::abs(change) > std::max(least_change, errors * error);
}

FocalLengthCheck::FocalLengthCheck(Device& device, const SurfaceMap& first)
    : device_(&device),
      first_(first.camera, first.window, {first.points().clone(), first.normals().clone()}),
      middle_(middle_of(first).value_or(Eigen::Vector3d::Zero())),
      partials_(focal_sums * static_cast<std::size_t>(first.window.height)),
      sums_(partials_.size()) {
  // No later frame asks the device for memory.
  first_.points().device(device);
  first_.normals().device(device);
  partials_.write_device(device);
}

void FocalLengthCheck::add(const SurfaceMap& view, const Eigen::Isometry3d& view_from_first) {
  constexpr double least_turn = 2 * degree;
  constexpr int fewest = 200;                                    // matches
  const Eigen::Vector3d axis = view_from_first.linear().row(2);  // of the view, in the first one's frame
  if (axis.dot(last_axis_) > std::cos(least_turn)) return;
  last_axis_ = axis;
  const FocalLengthEquations found = equations(view, view_from_first);
  if (found.motion.matches < fewest) return;
  const Eigen::Vector2d term = without_motion(found);
  curvature_ += term[0];
  gradient_ += term[1];
  products_ += term * term.transpose();
  variances_ += found.motion.squares / found.motion.matches;
  ++views_;
}

FocalLengthEstimate FocalLengthCheck::estimate() const {
  if (!(curvature_ > 0)) return {};
  const double change = -gradient_ / curvature_;
  const Eigen::Vector2d rest(change, 1);  // what the views' gradients differ from it by
  const double spread = views_ * std::max(rest.dot(products_ * rest), 0.0) / (curvature_ * curvature_);
  return {change, std::sqrt(spread + variances_ / curvature_), views_};
}

FocalLengthEquations FocalLengthCheck::equations(const SurfaceMap& view,
                                                 const Eigen::Isometry3d& view_from_first) {
  const ProjectiveIcpLevel limits = focal_length_limits(first_.window);
  const PixelWindow& window = first_.window;
  auto kernel = focal_kernel(*device_);
  device_->run("focal_length", kernel, static_cast<std::size_t>(window.height), 1,
               cl_int2{{window.width, window.height}}, first_.points().device(*device_),
               first_.normals().device(*device_), values_of(view_from_first),
               cl_float4{{static_cast<float>(middle_.x()), static_cast<float>(middle_.y()),
                          static_cast<float>(middle_.z()), 0}},
               pinhole(view.camera), frame_of(view), view.points().device(*device_),
               view.normals().device(*device_), static_cast<cl_float>(limits.max_distance),
               static_cast<cl_float>(limits.noise), static_cast<cl_float>(std::cos(limits.max_angle)),
               partials_.write_device(*device_));
  device_->read(partials_.device(*device_), sums_.data(), sums_.size() * sizeof(float));  // waits
  FocalLengthEquations sum;
  for (std::size_t row = 0; row < sums_.size(); row += focal_sums) {
    const RigidEquations motion = read_equations(sums_.data() + row);
    sum.motion.JtJ += motion.JtJ;
    sum.motion.Jtr += motion.Jtr;
    sum.motion.squares += motion.squares;
    sum.motion.matches += motion.matches;
    const float* focal = sums_.data() + row + rigid_sums;
    sum.mixed += Eigen::Map<const Eigen::Matrix<float, 6, 1>>(focal).cast<double>();
    sum.curvature += static_cast<double>(focal[6]);
    sum.gradient += static_cast<double>(focal[7]);
  }
  sum.motion.pivot = view_from_first * middle_;
  return sum;
}

}  // namespace pliant
