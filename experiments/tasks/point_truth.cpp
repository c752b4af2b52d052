#include "experiments/tasks/point_truth.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace pliant {
namespace {

PointErrors errors_of(std::vector<double> distances) {
  if (distances.empty()) return {};
  std::sort(distances.begin(), distances.end());
  const auto count = static_cast<double>(distances.size());
  return {static_cast<int>(distances.size()),
          std::accumulate(distances.begin(), distances.end(), 0.0) / count,
          distances[static_cast<std::size_t>(std::ceil(0.95 * count)) - 1], distances.back()};
}

}  // namespace

std::optional<FollowedErrors> PointTruth::error_of(const std::vector<Eigen::Vector3f>& points,
                                                   const Eigen::Isometry3d& camera_from_model,
                                                   int number) const {
  if (points.size() != pixels_.size()) throw std::invalid_argument("a followed point for each pixel");
  const auto truth = stream_.points_of(first_, pixels_, number);
  if (!truth) return {};
  const std::vector<bool> is_moving = find_moving(*truth, number);
  std::vector<double> all;
  std::vector<double> visible;
  std::vector<double> moving;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance =
        (camera_from_model * points[i].cast<double>() - truth->positions[i].cast<double>()).norm();
    if (!std::isfinite(distance)) continue;
    all.push_back(distance);
    if (truth->visible[i]) visible.push_back(distance);
    if (is_moving[i]) moving.push_back(distance);
  }
  return FollowedErrors{errors_of(std::move(all)), errors_of(std::move(visible)),
                        errors_of(std::move(moving))};
}

std::vector<bool> PointTruth::find_moving(const TruePoints& truth, int number) const {
  constexpr double least = 1;  // mm
  std::vector<bool> is_moving(pixels_.size());
  const auto began = stream_.camera_pose(first_);
  const auto pose = stream_.camera_pose(number);
  if (!start_ || !began || !pose) return is_moving;
  const Eigen::Isometry3d rigid = pose->inverse() * *began;
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    is_moving[i] =
        (rigid * start_->positions[i].cast<double>() - truth.positions[i].cast<double>()).norm() > least;
  return is_moving;
}

}  // namespace pliant
