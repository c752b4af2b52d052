#include "framework/geometry/animation.h"

#include <algorithm>
#include <stdexcept>

namespace pliant {
namespace {

/// Two keys around a moment, and how far it is from the first (0) to the second (1).
struct Between {
  std::size_t first = 0;
  std::size_t second = 0;
  double share = 0;
};

Between keys_around(const std::vector<double>& times, double seconds) {
  const auto after = std::upper_bound(times.begin(), times.end(), seconds);
  if (after == times.begin()) return {};
  const auto second = static_cast<std::size_t>(after - times.begin());
  if (after == times.end()) return {second - 1, second - 1, 0};
  const double span = times[second] - times[second - 1];
  return {second - 1, second, (seconds - times[second - 1]) / span};
}

const double* value_of(const Track& track, std::size_t key) {
  const bool is_cubic = track.interpolation == Track::Interpolation::cubic;
  return track.values.data() + track.width * (is_cubic ? 3 * key + 1 : key);
}

/// glTF 2.0, appendix C.5.
double hermite(const Track& track, const Between& at, std::size_t i) {
  const double span = track.times[at.second] - track.times[at.first];
  const double t = at.share;
  const double t2 = t * t;
  const double t3 = t2 * t;
  const double out_of_first = value_of(track, at.first)[track.width + i];
  const double into_second = *(value_of(track, at.second) - track.width + i);
  return (2 * t3 - 3 * t2 + 1) * value_of(track, at.first)[i] + span * (t3 - 2 * t2 + t) * out_of_first +
         (3 * t2 - 2 * t3) * value_of(track, at.second)[i] + span * (t3 - t2) * into_second;
}

double blended(const Track& track, const Between& at, std::size_t i) {
  const double first = value_of(track, at.first)[i];
  if (at.first == at.second || track.interpolation == Track::Interpolation::step) return first;
  if (track.interpolation == Track::Interpolation::cubic) return hermite(track, at, i);
  return first + at.share * (value_of(track, at.second)[i] - first);
}

Eigen::Vector3d vector_at(const std::optional<Track>& track, const Eigen::Vector3d& fixed, double seconds) {
  return track ? Eigen::Vector3d(track->at(seconds).data()) : fixed;
}

}  // namespace

std::vector<double> Track::at(double seconds) const {
  const Between between = keys_around(times, seconds);
  std::vector<double> numbers(width);
  for (std::size_t i = 0; i < width; ++i) numbers[i] = blended(*this, between, i);
  return numbers;
}

Eigen::Quaterniond Track::rotation_at(double seconds) const {
  const auto quaternion = [](const double* xyzw) {
    return Eigen::Quaterniond(Eigen::Vector4d(xyzw)).normalized();
  };
  if (interpolation != Interpolation::linear) return quaternion(at(seconds).data());
  const Between between = keys_around(times, seconds);
  return quaternion(value_of(*this, between.first))
      .slerp(between.share, quaternion(value_of(*this, between.second)));
}

Eigen::Affine3d JointMotion::at(double seconds) const {
  return Eigen::Translation3d(vector_at(translations, translation, seconds)) *
         (rotations ? rotations->rotation_at(seconds) : rotation) *
         Eigen::Scaling(vector_at(scales, scale, seconds));
}

MeshPose Animation::pose(const Mesh& mesh, double seconds) const {
  MeshPose pose = mesh.rest();
  for (const JointMotion& motion : joints) {
    if (motion.joint < 0 || static_cast<std::size_t>(motion.joint) >= pose.joints.size())
      throw std::invalid_argument("an animation moves a joint that the mesh does not have");
    pose.joints[static_cast<std::size_t>(motion.joint)] = motion.at(seconds);
  }
  for (const WeightMotion& motion : weights) {
    const std::vector<double> now = motion.weights.at(seconds);
    for (std::size_t i = 0; i < motion.targets.size(); ++i) {
      if (motion.targets[i] >= pose.weights.size())
        throw std::invalid_argument("an animation moves a morph target that the mesh does not have");
      pose.weights[motion.targets[i]] = now[i];
    }
  }
  return pose;
}

}  // namespace pliant
