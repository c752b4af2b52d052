#include "framework/pose/keyframes.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pliant {

void ModelFeatures::append(const ModelFeatures& more) {
  descriptors.insert(descriptors.end(), more.descriptors.begin(), more.descriptors.end());
  points.insert(points.end(), more.points.begin(), more.points.end());
}

/// 1 where one of the limits is just met.
double Keyframes::difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
  const double shift = (a * middle_ - b * middle_).norm();
  const double turn = Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
  return std::max(shift / options_.distance, turn / options_.angle);
}

bool Keyframes::wants(const Eigen::Isometry3d& camera_from_model) const {
  return std::all_of(keyframes_.begin(), keyframes_.end(), [&](const Keyframe& kept) {
    return difference(kept.camera_from_model, camera_from_model) >= 1;
  });
}

void Keyframes::add(Keyframe keyframe) {
  keyframes_.push_back(std::move(keyframe));
  if (keyframes_.size() > static_cast<std::size_t>(options_.most)) drop_one();
}

void Keyframes::drop_one() {
  double least = std::numeric_limits<double>::infinity();
  auto dropped = keyframes_.begin();
  for (auto older = keyframes_.begin(); older != keyframes_.end(); ++older) {
    for (auto newer = older + 1; newer != keyframes_.end(); ++newer) {
      const double between = difference(older->camera_from_model, newer->camera_from_model);
      if (between >= least) continue;
      least = between;
      dropped = older;
    }
  }
  keyframes_.erase(dropped);
}

}  // namespace pliant
