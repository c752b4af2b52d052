#include "experiments/view/surface_attachment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

namespace pliant {
namespace {

/// Whether a rotation can be told by points: they spread by more than noise in two directions.
bool is_spread(const Eigen::Matrix3Xd& points) {
  constexpr double least_spread = 1;  // mm, root mean square
  if (points.cols() < 3) return false;
  const Eigen::Matrix3Xd offsets = points.colwise() - points.rowwise().mean().eval();
  const Eigen::Matrix3d covariance = offsets * offsets.transpose() / static_cast<double>(points.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()[1] > least_spread * least_spread;
}

}  // namespace

SurfaceAttachment::SurfaceAttachment(const std::vector<Eigen::Vector3f>& points,
                                     const Eigen::Vector3d& anchor, double reach) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i].cast<double>() - anchor).norm();
    if (distance <= reach) near.emplace_back(distance, i);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), most));
  for (const auto& [distance, point] : near) carriers_.push_back(point);
  rest_ = places_of(points);
  can_turn_ = is_spread(rest_);
}

Eigen::Isometry3d SurfaceAttachment::motion(const std::vector<Eigen::Vector3f>& points) const {
  if (carriers_.empty()) return Eigen::Isometry3d::Identity();
  const Eigen::Matrix3Xd now = places_of(points);
  if (can_turn_) return Eigen::Isometry3d(Eigen::umeyama(rest_, now, false));
  return Eigen::Isometry3d(Eigen::Translation3d(now.rowwise().mean() - rest_.rowwise().mean()));
}

Eigen::Matrix3Xd SurfaceAttachment::places_of(const std::vector<Eigen::Vector3f>& points) const {
  Eigen::Matrix3Xd places(3, carriers_.size());
  for (std::size_t i = 0; i < carriers_.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = points[carriers_[i]].cast<double>();
  return places;
}

}  // namespace pliant
