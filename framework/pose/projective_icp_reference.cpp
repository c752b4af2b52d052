#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "framework/pose/projective_icp.h"
#include "framework/pose/rigid_equation.h"

namespace pliant {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Offsets of the pixels that a level looks at.
std::vector<std::size_t> pixels_of(const PixelWindow& window, int step) {
  std::vector<std::size_t> pixels;
  const int first = (step - 1) / 2;
  for (int row = first; row < window.height; row += step)
    for (int column = first; column < window.width; column += step)
      pixels.push_back(window.offset(window.left + column, window.top + row));
  return pixels;
}

struct Extent {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double size = 1;
};

Extent extent_of(const SurfaceMap& map, int step) {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t pixel : pixels_of(map.window, step)) {
    const Eigen::Vector3f p = finite_or_none(map.points(), pixel);
    if (p.z() > 0) points.push_back(p.cast<double>());
  }
  Extent extent;
  if (points.empty()) return extent;
  for (const Eigen::Vector3d& p : points) extent.middle += p / static_cast<double>(points.size());
  double squares = 0;
  for (const Eigen::Vector3d& p : points) squares += (p - extent.middle).squaredNorm();
  extent.size = std::sqrt(std::max(squares / static_cast<double>(points.size()), 1.0));
  return extent;
}

/// A motion as the kernels have it, in double.
struct State {
  Eigen::Isometry3d pose;
  Vector6 moved = Vector6::Zero();  ///< since the start: turns, as vectors, and shifts
  RigidEquations last;
  int iterations = 0;
  bool gave_up = false;
};

/// Whether it was the last step of its level.
bool take_step(const Extent& extent, double damping, double tolerance, State& state) {
  Vector6 unit = Vector6::Ones();
  unit.head<3>().setConstant(1 / extent.size);
  Eigen::Matrix<double, 6, 6> A = unit.asDiagonal() * state.last.JtJ * unit.asDiagonal();
  const double pull = damping * A.trace() / 6;
  A.diagonal().array() += pull;
  const Vector6 b = -unit.cwiseProduct(state.last.Jtr) - pull * state.moved.cwiseQuotient(unit);
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(A);
  ++state.iterations;
  if (state.last.matches < 6 || factor.info() != Eigen::Success) {
    state.gave_up = true;
    return true;
  }
  const Vector6 step = factor.solve(b);
  const Vector6 moved = unit.cwiseProduct(step);
  const Eigen::Vector3d turn = moved.head<3>();
  const Eigen::Vector3d place = state.pose * extent.middle;
  const Eigen::AngleAxisd rotation(turn.norm(),
                                   turn.norm() > 0 ? turn.normalized() : Eigen::Vector3d::UnitX());
  state.pose =
      Eigen::Translation3d(place + moved.tail<3>()) * rotation * Eigen::Translation3d(-place) * state.pose;
  state.moved += moved;
  return step.head<3>().norm() < tolerance && step.tail<3>().norm() < tolerance;
}

}  // namespace

RigidEquations projective_equations_reference(const SurfaceMap& source, const SurfaceMap& target,
                                              const Eigen::Isometry3d& pose, const Eigen::Vector3d& pivot,
                                              const ProjectiveIcpLevel& level) {
  RigidEquations equations;
  equations.pivot = pivot;
  for (const std::size_t pixel : pixels_of(source.window, level.step)) {
    const Eigen::Vector3d p = finite_or_none(source.points(), pixel).cast<double>();
    if (!(p.z() > 0)) continue;
    ++equations.samples;
    const Eigen::Vector3d moved = pose * p;
    const auto landed = pixel_reference(target.camera, moved.cast<float>());
    if (!landed) continue;
    const Eigen::Vector3d q = finite_or_none(target, target.points(), *landed).cast<double>();
    if (!(q.z() > 0)) continue;
    ++equations.landed;
    const Eigen::Vector3d own = pose.linear() * finite_or_none(source.normals(), pixel).cast<double>();
    const Eigen::Vector3d other = finite_or_none(target, target.normals(), *landed).cast<double>();
    const Eigen::Vector3d offset = moved - q;
    const bool is_turned = !other.isZero(0) && own.dot(other) < std::cos(level.max_angle);
    if (own.isZero(0) || offset.norm() > level.farthest(q.z()) || is_turned) continue;
    ++equations.matches;
    const Eigen::Vector3d lever = q - pivot;
    Vector6 J;
    plane_distance_jacobian(lever.data(), own.data(), J.data());
    const double r = plane_distance(offset.data(), own.data());
    equations.JtJ += J * J.transpose();
    equations.Jtr += J * r;
    equations.squares += r * r;
  }
  return equations;
}

PoseEstimate projective_icp_reference(const SurfaceMap& source, const SurfaceMap& target,
                                      const Eigen::Isometry3d& start, const ProjectiveIcpOptions& options) {
  const std::vector<ProjectiveIcpLevel> levels = levels_of(options, source.window);
  const Extent extent = extent_of(source, levels.front().step);
  State state;
  state.pose = start;
  for (const ProjectiveIcpLevel& level : levels) {
    bool done = state.gave_up;
    for (int i = 0; i < options.iterations && !done; ++i) {
      state.last =
          projective_equations_reference(source, target, state.pose, state.pose * extent.middle, level);
      done = take_step(extent, level.damping, level.tolerance, state);
    }
  }
  return judged({state.pose, state.last, extent.middle, extent.size, state.iterations, state.gave_up}, start,
                options);
}

}  // namespace pliant
