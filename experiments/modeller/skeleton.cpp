#include "experiments/modeller/skeleton.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace pliant {
namespace {

double distance_from(const Bone& bone, const Eigen::Vector3d& point) {
  const Eigen::Vector3d along = bone.to - bone.from;
  const double share = std::clamp(along.dot(point - bone.from) / along.squaredNorm(), 0.0, 1.0);
  return (point - bone.from - share * along).norm() - bone.radius;
}

Eigen::Affine3d frame_of(const Bone& bone, const Eigen::Vector3d& x_axis) {
  const Eigen::Vector3d y = (bone.to - bone.from).normalized();
  const Eigen::Vector3d x = (x_axis - y * y.dot(x_axis)).normalized();
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
  frame.linear() << x, y, x.cross(y);
  frame.translation() = bone.from;
  return frame;
}

}  // namespace

Skeleton& Skeleton::add(const std::string& joint, const std::string& parent, const Bone& bone, double blend,
                        const Eigen::Vector3d& x_axis) {
  Joint made;
  made.name = joint;
  const Eigen::Affine3d frame = frame_of(bone, x_axis);
  made.joint_from_mesh = frame.inverse(Eigen::Isometry);
  made.rest = frame;
  if (!parent.empty()) {
    const auto found = std::find_if(parts_.begin(), parts_.end(),
                                    [&](const Part& part) { return part.joint.name == parent; });
    if (found == parts_.end()) throw std::logic_error("no joint " + parent + " was added");
    made.parent = static_cast<int>(found - parts_.begin());
    made.rest = found->joint.joint_from_mesh * frame;
  }
  parts_.push_back({made, {bone}, blend});
  return *this;
}

Skeleton& Skeleton::also(const Bone& bone) {
  parts_.back().bones.push_back(bone);
  return *this;
}

void Skeleton::bind(Mesh& mesh) const {
  mesh.joints.clear();
  for (const Part& part : parts_) mesh.joints.push_back(part.joint);
  mesh.skin.clear();
  mesh.skin.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) mesh.skin.push_back(weights_at(vertex.cast<double>()));
}

JointWeights Skeleton::weights_at(const Eigen::Vector3d& point) const {
  std::vector<double> distances;  // of each joint's nearest bone
  for (const Part& part : parts_) {
    double least = std::numeric_limits<double>::max();
    for (const Bone& bone : part.bones) least = std::min(least, distance_from(bone, point));
    distances.push_back(least);
  }
  const double nearest = *std::min_element(distances.begin(), distances.end());
  std::vector<std::pair<double, int>> shares;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double share = 1 - (distances[i] - nearest) / parts_[i].blend;
    if (share > 0) shares.emplace_back(share * share, static_cast<int>(i));
  }
  std::sort(shares.rbegin(), shares.rend());
  JointWeights carried;
  for (std::size_t i = 0; i < std::min<std::size_t>(shares.size(), 4); ++i) {
    carried.joints[static_cast<Eigen::Index>(i)] = shares[i].second;
    carried.weights[static_cast<Eigen::Index>(i)] = static_cast<float>(shares[i].first);
  }
  carried.weights /= carried.weights.sum();
  return carried;
}

}  // namespace pliant
