#include "framework/pose/rigid_icp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "framework/pose/rigid_equation.h"
#include "framework/pose/rigid_icp.cl.embed.h"

namespace pliant {
namespace {

constexpr std::size_t pose_size = 16;  // POSE_SIZE in rigid_icp.cl, and so on
constexpr std::size_t pose_pivot = 9;
constexpr std::size_t pose_status = 12;
constexpr std::size_t pose_iterations = 13;

constexpr int fewest_samples = 512;     // a level is no coarser than this
constexpr int judged_samples = 1024;    // of the target, about
constexpr double fewest_matches = 0.1;  // of the samples
constexpr double fewest_known = 0.25;
constexpr double cut_share = 0.25;
constexpr double tolerance = 1e-3;
/// Of the mean diagonal of J^T J: directions that nothing tells of stay still, the others hardly notice.
constexpr double damping = 1e-5;

int vector_padded(int count, int width) { return (count + width - 1) / width * width; }

std::size_t chunks_of(int padded, int width) {
  const int chunk = 16 * width;  // CHUNK
  return static_cast<std::size_t>((padded + chunk - 1) / chunk);
}

cl::Kernel rigid_kernel(Device& device, const std::string& name) {
  static const std::string scalar = with_rigid_step(1, embedded::framework_pose_rigid_icp_cl);
  static const std::string vector = with_rigid_step(16, embedded::framework_pose_rigid_icp_cl);
  return device.kernel(device.width() == 1 ? scalar : vector, name);
}

/// What the search starts from beside the given start: no turn, one about each axis, both about x and y, and
/// twice as far about x or y, where most of what was seen is hidden.
std::vector<Eigen::Quaterniond> search_turns(double angle) {
  std::vector<Eigen::Quaterniond> turns{Eigen::Quaterniond::Identity()};
  const auto turn = [](double by, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(by, axis.normalized()));
  };
  for (const double sign : {1.0, -1.0}) {
    for (int axis = 0; axis < 3; ++axis) turns.push_back(turn(sign * angle, Eigen::Vector3d::Unit(axis)));
    for (const double other : {1.0, -1.0}) turns.push_back(turn(sign * angle, {1, other, 0}));
    for (int axis = 0; axis < 2; ++axis) turns.push_back(turn(2 * sign * angle, Eigen::Vector3d::Unit(axis)));
  }
  return turns;
}

/// Why there is no answer, or none that stands still.
void explain(RigidIcpResult& result, bool gave_up) {
  result.failed = gave_up || !result.pose.matrix().allFinite() ||
                  result.inliers < std::max(6.0, fewest_matches * result.samples);
  if (result.failed)
    result.reason =
        fmt::format("{} of {} points have a match, fewer than a tenth", result.inliers, result.samples);
  else if (!result.converged)
    result.reason = "it still moved when its iterations were over";
}

}  // namespace

RigidIcp::RigidIcp(Device& device, const RigidIcpOptions& options) : device_(&device), options_(options) {
  for (int i = 0; i < options.levels; ++i) {
    const double share =
        options.levels > 1 ? static_cast<double>(options.levels - 1 - i) / (options.levels - 1) : 0;
    levels_.push_back({i, share, {}});
  }
}

void RigidIcp::pack(const SeenSurface& surface, int stride, Samples& samples) {
  const auto available = static_cast<int>(surface.pixels.size());
  samples.count = (available + stride - 1) / stride;
  samples.padded = vector_padded(samples.count, device_->width());
  samples.values.make_room(6 * static_cast<std::size_t>(samples.padded));
  auto kernel = rigid_kernel(*device_, "pack");
  device_->run("icp", kernel, static_cast<std::size_t>(samples.padded), 16, available,
               surface.pixels.device(*device_), stride, surface.map.points().device(*device_),
               surface.map.normals().device(*device_), samples.padded, samples.values.write_device(*device_));
}

void RigidIcp::prepare(const SeenSurface& source, const SeenSurface& target) {
  const int coarsest = std::max(options_.step, static_cast<int>(source.pixels.size()) / fewest_samples);
  for (Level& level : levels_) {
    const int finer_levels = options_.levels - 1 - level.number;
    const double stride = options_.step * std::pow(4.0, finer_levels);
    pack(source, static_cast<int>(std::min<double>(stride, coarsest)), level.samples);
  }
  pack(target, std::max(1, static_cast<int>(target.pixels.size()) / judged_samples), target_samples_);
  extents_.make_room(8);
  const Samples& coarse = levels_.front().samples;
  auto kernel = rigid_kernel(*device_, "measure");
  device_->run("icp", kernel, 2, 1, coarse.padded, coarse.values.device(*device_), target_samples_.padded,
               target_samples_.values.device(*device_), extents_.write_device(*device_));
}

void RigidIcp::set_out(const std::vector<Start>& starts) {
  std::vector<float> values;
  for (const Start& start : starts) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        values.push_back(static_cast<float>(start.pose.linear()(row, column)));
    for (int row = 0; row < 3; ++row) values.push_back(static_cast<float>(start.pose.translation()[row]));
    values.push_back(start.is_centred ? 1.0F : 0.0F);
  }
  starts_ = Array<float>(std::move(values));
  poses_.make_room(pose_size * starts.size());
  auto kernel = rigid_kernel(*device_, "set_out");
  device_->run("icp", kernel, starts.size(), 1, static_cast<cl_int>(starts.size()), starts_.device(*device_),
               extents_.device(*device_), poses_.write_device(*device_));
}

/// `number`: of the level, or -1 to match whatever became of the poses.
void RigidIcp::accumulate(const Level& level, int number, int poses, const SeenSurface& target) {
  const auto items = static_cast<std::size_t>(poses) * chunks_of(level.samples.padded, device_->width());
  const double angle = level.share * options_.coarse_angle + (1 - level.share) * options_.max_angle;
  partials_.make_room(rigid_sums * items);
  auto kernel = rigid_kernel(*device_, "accumulate");
  device_->run("icp", kernel, items, 1, poses, number, level.samples.padded,
               level.samples.values.device(*device_), poses_.device(*device_), extents_.device(*device_),
               pinhole(target.map.camera), frame_of(target.map), target.map.points().device(*device_),
               target.map.normals().device(*device_), static_cast<cl_float>(options_.max_distance),
               static_cast<cl_float>(options_.coarse_distance), static_cast<cl_float>(level.share),
               trim_of(level), static_cast<cl_float>(std::cos(angle)), partials_.write_device(*device_));
}

cl_float RigidIcp::trim_of(const Level& level) const {
  return static_cast<cl_float>(level.number + 1 == options_.levels ? options_.trim : 0);
}

void RigidIcp::refine(const Level& level, int poses, const SeenSurface& target) {
  auto kernel = rigid_kernel(*device_, "take_step");
  for (int i = 0; i < options_.iterations; ++i) {
    accumulate(level, level.number, poses, target);
    device_->run(
        "icp", kernel, static_cast<std::size_t>(poses), 1, poses, level.number, level.samples.padded,
        partials_.device(*device_), extents_.device(*device_), static_cast<cl_float>(options_.max_distance),
        static_cast<cl_float>(options_.coarse_distance), static_cast<cl_float>(level.share), trim_of(level),
        static_cast<cl_float>(std::max(6.0, fewest_matches * level.samples.count)),
        static_cast<cl_float>(damping), static_cast<cl_float>(tolerance), poses_.write_device(*device_));
  }
}

void RigidIcp::judge(int poses, const SeenSurface& source, const SeenSurface& target) {
  const Samples& coarse = levels_.front().samples;
  const auto width = device_->width();
  const auto items = static_cast<std::size_t>(poses) *
                     (chunks_of(coarse.padded, width) + chunks_of(target_samples_.padded, width));
  judged_.make_room(2 * items);
  residuals_.make_room(static_cast<std::size_t>(poses));
  auto judge = rigid_kernel(*device_, "judge");
  device_->run("icp", judge, items, 1, poses, coarse.padded, coarse.values.device(*device_),
               target_samples_.padded, target_samples_.values.device(*device_), poses_.device(*device_),
               extents_.device(*device_), pinhole(source.map.camera), frame_of(source.map),
               source.map.points().device(*device_), pinhole(target.map.camera), frame_of(target.map),
               target.map.points().device(*device_), static_cast<cl_float>(cut_share),
               judged_.write_device(*device_));
  auto verdict = rigid_kernel(*device_, "verdict");
  const cl_float2 fewest = {{static_cast<float>(std::max(1.0, fewest_known * coarse.count)),
                             static_cast<float>(std::max(1.0, fewest_known * target_samples_.count))}};
  device_->run("icp", verdict, static_cast<std::size_t>(poses), 1, poses, coarse.padded,
               target_samples_.padded, judged_.device(*device_), extents_.device(*device_),
               static_cast<cl_float>(cut_share), fewest, residuals_.write_device(*device_));
}

RigidIcpResult RigidIcp::align(const SeenSurface& source, const SeenSurface& target,
                               const Eigen::Isometry3d& start) {
  prepare(source, target);
  std::vector<Start> starts{{start, false}};
  if (options_.search_angle > 0)
    for (const auto& turn : search_turns(options_.search_angle)) starts.push_back({turn * start, true});
  const auto tried = static_cast<int>(starts.size());
  starts.push_back({start, false});  // stays, to be judged at the end
  set_out(starts);
  if (tried > 1) {
    refine(levels_.front(), tried, target);
    judge(tried, source, target);
    auto kernel = rigid_kernel(*device_, "choose");
    device_->run("icp", kernel, 1, 1, tried + 1, residuals_.device(*device_), poses_.write_device(*device_));
  }
  for (const Level& level : levels_)
    if (tried == 1 || level.number > 0) refine(level, 1, target);
  judge(2, source, target);
  accumulate(levels_.back(), -1, 1, target);
  return read_result();
}

TwoWayResidual RigidIcp::residual(const SeenSurface& source, const SeenSurface& target,
                                  const Eigen::Isometry3d& pose) {
  prepare(source, target);
  set_out({{pose, false}});
  judge(1, source, target);
  return read_residuals(1).front();
}

RigidEquations RigidIcp::equations(const SeenSurface& source, const SeenSurface& target,
                                   const Eigen::Isometry3d& pose) {
  prepare(source, target);
  set_out({{pose, false}});
  accumulate(levels_.back(), -1, 1, target);
  RigidEquations equations = read_sums();
  equations.pivot = pose * Eigen::Vector3d(read_extent().head<3>());
  return equations;
}

/// Of the source: x y z of its middle, and its size.
Eigen::Vector4d RigidIcp::read_extent() {
  Eigen::Vector4f extent;
  device_->read(extents_.device(*device_), extent.data(), sizeof(extent));
  return extent.cast<double>();
}

std::vector<TwoWayResidual> RigidIcp::read_residuals(std::size_t count) {
  std::vector<float> means(count);
  device_->read(residuals_.device(*device_), means.data(), count * sizeof(float));
  const double cut = cut_share * read_extent()[3];
  std::vector<TwoWayResidual> residuals;
  for (const float mean : means) residuals.push_back({mean, cut});
  return residuals;
}

RigidEquations RigidIcp::read_sums() {
  sums_.make_room(rigid_sums);
  auto kernel = rigid_kernel(*device_, "add_up");
  device_->run("icp", kernel, 1, 1, levels_.back().samples.padded, partials_.device(*device_),
               sums_.write_device(*device_));
  std::array<float, rigid_sums> sums{};
  device_->read(sums_.device(*device_), sums.data(), sizeof(sums));
  return read_equations(sums.data());
}

RigidIcpResult RigidIcp::read_result() {
  RigidIcpResult result;
  const RigidEquations equations = read_sums();  // waits
  const std::vector<TwoWayResidual> residuals = read_residuals(2);
  const Eigen::Vector4d extent = read_extent();
  std::array<float, pose_size> pose{};
  device_->read(poses_.device(*device_), pose.data(), sizeof(pose));
  const Eigen::Matrix3f rotation = Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(pose.data());
  const Eigen::Quaterniond turn = Eigen::Quaterniond(rotation.cast<double>()).normalized();
  const Eigen::Vector3d middle = Eigen::Map<Eigen::Vector3f>(pose.data() + pose_pivot).cast<double>();
  result.pose = Eigen::Translation3d(middle) * turn * Eigen::Translation3d(-extent.head<3>());
  result.samples = levels_.back().samples.count;
  result.inliers = equations.matches;
  result.mean_error = equations.matches > 0 ? std::sqrt(equations.squares / equations.matches) : 0;
  result.after = residuals[0];
  result.before = residuals[1];
  result.conditioning = conditioning_of(eigenvalues_of(equations, extent[3]));
  result.iterations = static_cast<int>(pose[pose_iterations]);
  result.converged = pose[pose_status] == static_cast<float>(options_.levels);
  explain(result, pose[pose_status] < 0);
  return result;
}

// --- plain C++ references ---

namespace {

/// The motion in the numbers that the kernels see.
struct PlainMotion {
  Eigen::Matrix3f turn;
  Eigen::Vector3f from;
  Eigen::Vector3f to;

  PlainMotion(const Eigen::Isometry3d& pose, const Eigen::Vector3d& pivot)
      : turn(pose.linear().cast<float>()),
        from((pose.inverse() * pivot).cast<float>()),
        to(pivot.cast<float>()) {}
};

struct Direction {
  double sum = 0;
  int known = 0;
};

Direction compare_reference(const SeenSurface& surface, const PlainMotion& motion, const SeenSurface& other,
                            double cut) {
  Direction direction;
  for (const int sample : surface.pixels.host()) {
    const Eigen::Vector3f p = finite_or_none(surface.map.points(), static_cast<std::size_t>(sample));
    if (!(p.z() > 0)) continue;
    const Eigen::Vector3f moved = motion.turn * (p - motion.from) + motion.to;
    const Eigen::Vector3f normal =
        motion.turn * finite_or_none(surface.map.normals(), static_cast<std::size_t>(sample));
    const auto pixel = pixel_reference(other.map.camera, moved);
    if (!pixel || normal.dot(moved) > 0) continue;
    const Eigen::Vector3f q = finite_or_none(other.map, other.map.points(), *pixel);
    direction.sum += q.z() > 0 ? std::min<double>((moved - q).norm(), cut) : cut;
    ++direction.known;
  }
  return direction;
}

double mean_of(const Direction& direction, std::size_t samples, double cut) {
  const bool is_known = direction.known >= std::max(1.0, fewest_known * static_cast<double>(samples));
  return is_known ? direction.sum / direction.known : cut;
}

}  // namespace

RigidEquations rigid_equations_reference(const SeenSurface& source, const SeenSurface& target,
                                         const Eigen::Isometry3d& pose, const Eigen::Vector3d& pivot,
                                         const RigidIcpOptions& options) {
  const PlainMotion motion(pose, pivot);
  RigidEquations equations;
  equations.pivot = pivot;
  for (const int sample : source.pixels.host()) {
    const Eigen::Vector3f p = finite_or_none(source.map.points(), static_cast<std::size_t>(sample));
    const Eigen::Vector3f own =
        motion.turn * finite_or_none(source.map.normals(), static_cast<std::size_t>(sample));
    const Eigen::Vector3f arm = motion.turn * (p - motion.from);
    const auto pixel = pixel_reference(target.map.camera, arm + motion.to);
    if (!(p.z() > 0) || !pixel) continue;
    const Eigen::Vector3f q = finite_or_none(target.map, target.map.points(), *pixel);
    if (!(q.z() > 0)) continue;
    ++equations.landed;
    const Eigen::Vector3f n = finite_or_none(target.map, target.map.normals(), *pixel);
    const Eigen::Vector3f offset = arm + motion.to - q;
    const bool is_alike = own.isZero(0) || own.dot(n) >= static_cast<float>(std::cos(options.max_angle));
    if (n.isZero(0) || offset.norm() > options.max_distance || !is_alike) continue;
    ++equations.matches;
    Eigen::Matrix<float, 6, 1> J;
    plane_distance_jacobian(arm.data(), n.data(), J.data());
    const double r = plane_distance(offset.data(), n.data());
    equations.JtJ += J.cast<double>() * J.cast<double>().transpose();
    equations.Jtr += J.cast<double>() * r;
    equations.squares += r * r;
  }
  return equations;
}

TwoWayResidual two_way_residual_reference(const SeenSurface& source, const SeenSurface& target,
                                          const Eigen::Isometry3d& pose, double cut) {
  const Direction there = compare_reference(source, {pose, pose.translation()}, target, cut);
  const Direction back =
      compare_reference(target, {pose.inverse(), pose.inverse().translation()}, source, cut);
  return {0.5 * (mean_of(there, source.pixels.size(), cut) + mean_of(back, target.pixels.size(), cut)), cut};
}

}  // namespace pliant
