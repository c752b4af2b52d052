#include "framework/evaluation/trajectory_error.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/core/angle.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

struct PosePair {
  Eigen::Isometry3d estimate;
  Eigen::Isometry3d truth;
};

const TimedPose& nearest_in_time(const Trajectory& trajectory, double time) {
  const auto later = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                      [](const TimedPose& pose, double at) { return pose.time < at; });
  if (later == trajectory.begin()) return *later;
  const auto before = later - 1;
  return later == trajectory.end() || time - before->time <= later->time - time ? *before : *later;
}

std::vector<PosePair> paired(const Trajectory& estimate, const Trajectory& truth, double apart) {
  std::vector<PosePair> pairs;
  for (const TimedPose& pose : estimate) {
    if (truth.empty()) break;
    const TimedPose& nearest = nearest_in_time(truth, pose.time);
    if (std::abs(nearest.time - pose.time) <= apart) pairs.push_back({pose.pose, nearest.pose});
  }
  if (pairs.empty())
    throw DataError(
        fmt::format("no pose of the estimate is within {:g} s of one of the truth ({} and {} poses)", apart,
                    estimate.size(), truth.size()));
  return pairs;
}

/// The motion of the places that brings the estimate's nearest to the truth's.
Eigen::Isometry3d motion_of_places(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3Xd from(3, pairs.size());
  Eigen::Matrix3Xd to(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].estimate.translation();
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].truth.translation();
  }
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

/// The rotation that brings the estimate's orientations nearest to the truth's. That of the places says
/// little of them where the camera hardly moved, or moved along a line.
Eigen::Matrix3d turn_of_orientations(const std::vector<PosePair>& pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) sum += pair.truth.linear() * pair.estimate.linear().transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d signs = Eigen::Matrix3d::Identity();
  signs(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * signs * svd.matrixV().transpose();
}

double squared_degrees(const Eigen::Matrix3d& turn) {
  const double degrees = Eigen::AngleAxisd(turn).angle() / degree;
  return degrees * degrees;
}

/// Makes means of sums of squares.
TrajectoryError rooted(TrajectoryError squares) {
  squares.translation = std::sqrt(squares.translation / squares.count);
  squares.rotation = std::sqrt(squares.rotation / squares.count);
  return squares;
}

}  // namespace

TrajectoryError absolute_error(const Trajectory& estimate, const Trajectory& truth,
                               TrajectoryAlignment alignment, double apart) {
  const std::vector<PosePair> pairs = paired(estimate, truth, apart);
  Eigen::Isometry3d places = pairs.front().truth * pairs.front().estimate.inverse();
  Eigen::Matrix3d turn = places.linear();
  if (alignment == TrajectoryAlignment::rigid) {
    places = motion_of_places(pairs);
    turn = turn_of_orientations(pairs);
  }
  TrajectoryError squares;
  for (const PosePair& pair : pairs) {
    squares.translation += (places * pair.estimate.translation() - pair.truth.translation()).squaredNorm();
    squares.rotation += squared_degrees(pair.truth.linear().transpose() * turn * pair.estimate.linear());
    ++squares.count;
  }
  return rooted(squares);
}

TrajectoryError relative_error(const Trajectory& estimate, const Trajectory& truth, int step, double apart) {
  const std::vector<PosePair> pairs = paired(estimate, truth, apart);
  TrajectoryError squares;
  for (std::size_t i = 0; i + static_cast<std::size_t>(step) < pairs.size(); ++i) {
    const PosePair& from = pairs[i];
    const PosePair& to = pairs[i + static_cast<std::size_t>(step)];
    const Eigen::Isometry3d error =
        (from.truth.inverse() * to.truth).inverse() * (from.estimate.inverse() * to.estimate);
    squares.translation += error.translation().squaredNorm();
    squares.rotation += squared_degrees(error.linear());
    ++squares.count;
  }
  if (squares.count == 0)
    throw DataError(
        fmt::format("no pair of poses {} apart among the {} that belong to the truth's", step, pairs.size()));
  return rooted(squares);
}

}  // namespace pliant
