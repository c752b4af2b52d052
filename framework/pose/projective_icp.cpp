#include "framework/pose/projective_icp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

constexpr int fewest_rows = 24;  // a level has no fewer rows or columns of samples than this, if it can

int sampled(int size, int step) { return (size + step / 2) / step; }

cl_int2 size_of(const SurfaceMap& map) { return {{map.window.width, map.window.height}}; }

/// Work-items of a matching, a RUN of 32 vectors each.
std::size_t runs_of(const PixelWindow& window, int step, int width) {
  const int runs = (sampled(window.width, step) + 32 * width - 1) / (32 * width);
  return static_cast<std::size_t>(sampled(window.height, step)) * static_cast<std::size_t>(runs);
}

void make_room(Array<float>& array, std::size_t size) {
  if (array.size() < size) array = Array<float>(size);
}

cl::Kernel icp_kernel(Device& device, const std::string& name) {
  static const std::string scalar = with_rigid_step(1, embedded::framework_pose_projective_icp_cl);
  static const std::string vector = with_rigid_step(16, embedded::framework_pose_projective_icp_cl);
  return device.kernel(device.width() == 1 ? scalar : vector, name);
}

cl_float16 values_of(const Eigen::Isometry3d& motion) {
  cl_float16 values{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      values.s[3 * row + column] = static_cast<float>(motion.linear()(row, column));
    values.s[9 + row] = static_cast<float>(motion.translation()[row]);
  }
  return values;
}

}  // namespace

/// What the kernels leave.
struct ProjectiveIcp::State {
  Eigen::Isometry3d pose;
  RigidEquations equations;
  Eigen::Vector3d middle;  ///< of the source
  double extent;
  int iterations;
  bool gave_up;
};

ProjectiveIcp::ProjectiveIcp(Device& device, const ProjectiveIcpOptions& options)
    : device_(&device), options_(options), state_(state_size) {}

std::vector<ProjectiveIcp::Level> ProjectiveIcp::levels_for(const PixelWindow& window) const {
  const int coarsest = std::max(1, std::min(window.width, window.height) / fewest_rows);
  std::vector<Level> levels;
  for (int i = 0; i < options_.levels; ++i) {
    const int finer = options_.levels - 1 - i;
    const double share = options_.levels > 1 ? static_cast<double>(finer) / (options_.levels - 1) : 0;
    const double reach = std::max(options_.coarse_distance / options_.max_distance, 1.0);
    const double angle = share * options_.coarse_angle + (1 - share) * options_.max_angle;
    levels.push_back({i, std::min(1 << finer, coarsest),
                      static_cast<float>(options_.max_distance * std::pow(reach, share)),
                      static_cast<float>(std::cos(angle))});
  }
  return levels;
}

void ProjectiveIcp::begin(const SurfaceMap& source, int step, const Eigen::Isometry3d& start) {
  make_room(partials_, rigid_sums * std::max(runs_of(source.window, 1, device_->width()),
                                             static_cast<std::size_t>(source.window.height)));
  const int rows = sampled(source.window.height, step);
  auto measure = icp_kernel(*device_, "measure");
  device_->run("icp", measure, static_cast<std::size_t>(rows), 1, size_of(source), step,
               source.points().device(*device_), partials_.write_device(*device_));
  auto begin = icp_kernel(*device_, "begin");
  device_->run("icp", begin, 1, 1, rows, partials_.device(*device_), values_of(start),
               state_.write_device(*device_));
}

void ProjectiveIcp::iterate(const Level& level, const SurfaceMap& source, const SurfaceMap& target) {
  const std::size_t runs = runs_of(source.window, level.step, device_->width());
  auto accumulate = icp_kernel(*device_, "accumulate");
  device_->run("icp", accumulate, runs, 1, level.number, size_of(source), level.step,
               source.points().device(*device_), source.normals().device(*device_), pinhole(target.camera),
               frame_of(target), target.points().device(*device_), target.normals().device(*device_),
               level.max_distance, level.least_cosine, state_.device(*device_),
               partials_.write_device(*device_));
  auto step = icp_kernel(*device_, "take_step");
  const auto items = static_cast<std::size_t>(device_->work_group_size());
  const double tolerance = options_.tolerance * level.max_distance / options_.max_distance;
  device_->run("icp", step, items, items, level.number, static_cast<cl_int>(runs), partials_.device(*device_),
               static_cast<cl_float>(options_.damping), static_cast<cl_float>(tolerance),
               state_.write_device(*device_));
}

PoseEstimate ProjectiveIcp::estimate(const SurfaceMap& source, const SurfaceMap& target,
                                     const Eigen::Isometry3d& start) {
  const std::vector<Level> levels = levels_for(source.window);
  begin(source, levels.front().step, start);
  for (const Level& level : levels)
    for (int i = 0; i < options_.iterations; ++i) iterate(level, source, target);
  const State state = read_state();  // waits
  PoseEstimate estimate;
  estimate.target_from_source = state.pose;
  estimate.samples = state.equations.samples;
  estimate.landed = state.equations.landed;
  estimate.inliers = state.equations.matches;
  estimate.mean_error =
      estimate.inliers > 0 ? std::sqrt(state.equations.squares / state.equations.matches) : 0;
  estimate.conditioning = conditioning_of(state.equations, state.extent);
  estimate.iterations = state.iterations;
  (void)start;
  judge(estimate, state);
  return estimate;
}

ProjectiveIcp::State ProjectiveIcp::read_state() const {
  std::array<float, state_size> values{};
  device_->read(state_.device(*device_), values.data(), sizeof(values));
  State state;
  const Eigen::Matrix3f rotation = Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(values.data());
  const Eigen::Quaterniond turn = Eigen::Quaterniond(rotation.cast<double>()).normalized();
  state.middle = Eigen::Map<Eigen::Vector3f>(values.data() + from).cast<double>();
  const Eigen::Vector3d place = Eigen::Map<Eigen::Vector3f>(values.data() + to).cast<double>();
  state.pose = Eigen::Translation3d(place) * turn * Eigen::Translation3d(-state.middle);
  state.equations = read_equations(values.data() + last);
  state.equations.pivot = place;
  state.extent = values[extent];
  state.iterations = static_cast<int>(values[iterations]);
  state.gave_up = values[status] < 0;
  return state;
}

void ProjectiveIcp::judge(PoseEstimate& estimate, const State& state) const {
  if (state.gave_up || estimate.samples == 0) {
    estimate.failed = true;
    estimate.reason = fmt::format("{} of {} points have a match", estimate.inliers, estimate.samples);
  }
}

}  // namespace pliant
