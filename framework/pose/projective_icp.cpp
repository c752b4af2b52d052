#include "framework/pose/projective_icp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/core/angle.h"
#include "framework/pose/projective_icp.cl.embed.h"

namespace pliant {
namespace {

constexpr std::size_t state_size = 32 + rigid_sums;  // LAST + SUMS in projective_icp.cl, and so on
constexpr std::size_t to = 9;
constexpr std::size_t status = 12;
constexpr std::size_t iterations = 13;
constexpr std::size_t from = 16;
constexpr std::size_t extent = 19;
constexpr std::size_t last = 32;

int sampled(int size, int step) { return (size + step / 2) / step; }

/// Work-items of a matching: runs of 32 vectors of a row.
std::size_t runs_of(const PixelWindow& window, int step, int width) {
  const int run = 32 * width;  // RUN
  const int runs = (sampled(window.width, step) + run - 1) / run;
  return static_cast<std::size_t>(sampled(window.height, step)) * static_cast<std::size_t>(runs);
}

cl_int2 size_of(const SurfaceMap& map) { return {{map.window.width, map.window.height}}; }

cl::Kernel projective_kernel(Device& device, const std::string& name) {
  static const std::string scalar = with_rigid_step(1, embedded::framework_pose_projective_icp_cl);
  static const std::string vector = with_rigid_step(16, embedded::framework_pose_projective_icp_cl);
  return device.kernel(device.width() == 1 ? scalar : vector, name);
}

/// Why a pose is no answer; empty when it is one.
std::string complaint(const PoseEstimate& estimate, const ProjectiveIcpState& state,
                      const Eigen::Isometry3d& start, const ProjectiveIcpOptions& options) {
  // Of distances up to a limit, all as likely as each other, it is 0.58 of the limit.
  constexpr double random_error = 0.5;
  const double depth = (state.pose * state.middle).z();
  const double error_limit = random_error * levels_of(options, {}).back().farthest(depth);
  if (estimate.samples == 0) return "the model shows no point";
  if (estimate.landed < options.min_overlap * estimate.samples)
    return fmt::format("{} of the model's {} points meet a point of the frame, expected {:g} %",
                       estimate.landed, estimate.samples, 100 * options.min_overlap);
  if (estimate.inliers < options.min_inliers * estimate.landed)
    return fmt::format("{} of {} matches are near and face alike, expected {:g} %", estimate.inliers,
                       estimate.landed, 100 * options.min_inliers);
  if (state.gave_up || !state.pose.matrix().allFinite())
    return fmt::format("{} matches do not tell a step", estimate.inliers);
  if (estimate.mean_error > error_limit)
    return fmt::format("the matches are {:.2f} mm apart, expected {:.1f} mm at most", estimate.mean_error,
                       error_limit);
  const Eigen::Isometry3d moved = state.pose * start.inverse();
  const double shift =
      std::min(moved.translation().norm(), (state.pose * state.middle - start * state.middle).norm());
  if (shift > options.max_shift)
    return fmt::format("it moved by {:.0f} mm, expected {:g} mm at most", shift, options.max_shift);
  const double turn = Eigen::AngleAxisd(moved.linear()).angle();
  if (turn > options.max_turn)
    return fmt::format("it turned by {:.1f} degrees, expected {:.1f} at most", turn / degree,
                       options.max_turn / degree);
  return "";
}

}  // namespace

std::vector<ProjectiveIcpLevel> levels_of(const ProjectiveIcpOptions& options, const PixelWindow& window) {
  constexpr int fewest_rows = 24;  // and columns, of the samples of a level, where there are as many
  const int coarsest = std::max(1, std::min(window.width, window.height) / fewest_rows);
  const double reach = std::max(options.coarse_distance / options.max_distance, 1.0);
  std::vector<ProjectiveIcpLevel> levels;
  for (int finer = options.levels - 1; finer >= 0; --finer) {
    const double share = options.levels > 1 ? static_cast<double>(finer) / (options.levels - 1) : 0;
    const int step = std::min(1 << finer, coarsest);
    levels.push_back({step, options.max_distance * std::pow(reach, share), options.noise,
                      share * options.coarse_angle + (1 - share) * options.max_angle,
                      options.tolerance * std::pow(reach, share), options.damping * step * step});
  }
  return levels;
}

double ProjectiveIcpLevel::farthest(double depth) const {
  const double beyond = depth / 1000 - 0.4;
  return std::max(max_distance, noise * (1.2 + 1.9 * beyond * beyond));
}

ProjectiveIcp::ProjectiveIcp(Device& device, const ProjectiveIcpOptions& options)
    : device_(&device), options_(options), state_(state_size) {}

void ProjectiveIcp::begin(const SurfaceMap& source, int step, const Eigen::Isometry3d& start) {
  const std::size_t room = rigid_sums * std::max(runs_of(source.window, 1, device_->width()),
                                                 static_cast<std::size_t>(source.window.height));
  partials_.make_room(room);
  const int rows = sampled(source.window.height, step);
  auto measure = projective_kernel(*device_, "measure");
  device_->run("icp", measure, static_cast<std::size_t>(rows), 1, size_of(source), step,
               source.points().device(*device_), partials_.write_device(*device_));
  auto begin = projective_kernel(*device_, "begin");
  device_->run("icp", begin, 1, 1, rows, partials_.device(*device_), values_of(start),
               state_.write_device(*device_));
}

void ProjectiveIcp::iterate(int number, const ProjectiveIcpLevel& level, const SurfaceMap& source,
                            const SurfaceMap& target) {
  const std::size_t runs = runs_of(source.window, level.step, device_->width());
  auto accumulate = projective_kernel(*device_, "accumulate");
  device_->run("icp", accumulate, runs, 1, number, size_of(source), level.step,
               source.points().device(*device_), source.normals().device(*device_), pinhole(target.camera),
               frame_of(target), target.points().device(*device_), target.normals().device(*device_),
               static_cast<cl_float>(level.max_distance), static_cast<cl_float>(level.noise),
               static_cast<cl_float>(std::cos(level.max_angle)), state_.device(*device_),
               partials_.write_device(*device_));
  auto step = projective_kernel(*device_, "take_step");
  const auto items = static_cast<std::size_t>(device_->work_group_size());
  device_->run("icp", step, items, items, number, static_cast<cl_int>(runs), partials_.device(*device_),
               static_cast<cl_float>(level.damping), static_cast<cl_float>(level.tolerance),
               state_.write_device(*device_));
}

PoseEstimate ProjectiveIcp::estimate(const SurfaceMap& source, const SurfaceMap& target,
                                     const Eigen::Isometry3d& start) {
  const std::vector<ProjectiveIcpLevel> levels = levels_of(options_, source.window);
  begin(source, levels.front().step, start);
  for (std::size_t number = 0; number < levels.size(); ++number)
    for (int i = 0; i < options_.iterations; ++i)
      iterate(static_cast<int>(number), levels[number], source, target);
  return judged(read_state(), start, options_);
}

RigidEquations ProjectiveIcp::equations(const SurfaceMap& source, const SurfaceMap& target,
                                        const Eigen::Isometry3d& pose) {
  begin(source, 1, pose);
  const Eigen::Vector3d pivot = pose * read_state().middle;
  iterate(0, levels_of(options_, source.window).back(), source, target);
  RigidEquations equations = read_state().equations;
  equations.pivot = pivot;
  return equations;
}

ProjectiveIcpState ProjectiveIcp::read_state() const {
  std::array<float, state_size> values{};
  device_->read(state_.device(*device_), values.data(), sizeof(values));  // waits
  ProjectiveIcpState state;
  const Eigen::Matrix3f rotation = Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(values.data());
  const Eigen::Quaterniond turn = Eigen::Quaterniond(rotation.cast<double>()).normalized();
  const Eigen::Vector3d place = Eigen::Map<Eigen::Vector3f>(values.data() + to).cast<double>();
  state.middle = Eigen::Map<Eigen::Vector3f>(values.data() + from).cast<double>();
  state.pose = Eigen::Translation3d(place) * turn * Eigen::Translation3d(-state.middle);
  state.equations = read_equations(values.data() + last);
  state.extent = values[extent];
  state.iterations = static_cast<int>(values[iterations]);
  state.gave_up = values[status] < 0;
  return state;
}

PoseEstimate judged(const ProjectiveIcpState& state, const Eigen::Isometry3d& start,
                    const ProjectiveIcpOptions& options) {
  constexpr double weak_pull = 0.1;
  PoseEstimate estimate;
  const RigidEquations& equations = state.equations;
  estimate.target_from_source = state.pose;
  estimate.samples = equations.samples;
  estimate.landed = equations.landed;
  estimate.inliers = equations.matches;
  estimate.mean_error = equations.matches > 0 ? std::sqrt(equations.squares / equations.matches) : 0;
  const auto values = eigenvalues_of(equations, state.extent);
  estimate.conditioning = conditioning_of(values);
  const double told = options.damping * values.mean() / weak_pull;
  estimate.weak_directions = static_cast<int>((values.array() <= told).count());
  estimate.iterations = state.iterations;
  estimate.reason = complaint(estimate, state, start, options);
  estimate.failed = !estimate.reason.empty();
  if (estimate.failed) estimate.target_from_source = start;
  return estimate;
}

}  // namespace pliant
