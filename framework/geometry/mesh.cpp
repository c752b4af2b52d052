#include "framework/geometry/mesh.h"

#include <cstddef>
#include <stdexcept>

namespace pliant {
namespace {

/// From the mesh's frame as it was bound to the mesh's frame as it is posed, through each joint.
std::vector<Eigen::Affine3d> carried_by(const std::vector<Joint>& joints,
                                        const std::vector<Eigen::Affine3d>& parent_from_joint) {
  if (parent_from_joint.size() != joints.size())
    throw std::invalid_argument("a pose takes one transform per joint");
  std::vector<Eigen::Affine3d> mesh_from_joint;
  std::vector<Eigen::Affine3d> carried;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const int parent = joints[i].parent;
    if (parent >= static_cast<int>(i)) throw std::invalid_argument("a joint stands before its parent");
    mesh_from_joint.push_back(parent < 0
                                  ? parent_from_joint[i]
                                  : mesh_from_joint[static_cast<std::size_t>(parent)] * parent_from_joint[i]);
    carried.push_back(mesh_from_joint.back() * joints[i].joint_from_mesh);
  }
  return carried;
}

Eigen::Vector3d blended(const Eigen::Vector3d& vertex, const JointWeights& skin,
                        const std::vector<Eigen::Affine3d>& carried) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 4; ++k) {
    if (skin.weights[k] == 0) continue;
    const int joint = skin.joints[k];
    if (joint < 0 || static_cast<std::size_t>(joint) >= carried.size())
      throw std::invalid_argument("a vertex names a joint that does not exist");
    sum += double{skin.weights[k]} * (carried[static_cast<std::size_t>(joint)] * vertex);
  }
  return sum;
}

}  // namespace

std::vector<std::string> Mesh::target_names() const {
  std::vector<std::string> names;
  for (const MorphTarget& target : targets) names.push_back(target.name);
  return names;
}

std::vector<Eigen::Vector3d> Mesh::deform(const std::vector<double>& weights) const {
  if (weights.size() != targets.size()) throw std::invalid_argument("a mesh takes one weight per target");
  std::vector<Eigen::Vector3d> deformed;
  deformed.reserve(vertices.size());
  for (const Eigen::Vector3f& vertex : vertices) deformed.push_back(vertex.cast<double>());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const auto& displacements = targets[t].displacements;
    if (displacements.size() != vertices.size()) {
      throw std::invalid_argument("a morph target takes one displacement per vertex");
    }
    if (weights[t] == 0) continue;
    for (std::size_t i = 0; i < deformed.size(); ++i)
      deformed[i] += weights[t] * displacements[i].cast<double>();
  }
  return deformed;
}

MeshPose Mesh::rest() const {
  MeshPose pose{std::vector<double>(targets.size(), 0), {}};
  for (const Joint& joint : joints) pose.joints.push_back(joint.rest);
  return pose;
}

std::vector<Eigen::Vector3d> Mesh::deform(const MeshPose& pose) const {
  std::vector<Eigen::Vector3d> deformed = deform(pose.weights);
  const std::vector<Eigen::Affine3d> carried = carried_by(joints, pose.joints);
  if (skin.empty()) return deformed;
  if (skin.size() != vertices.size()) throw std::invalid_argument("a skin takes one entry per vertex");
  for (std::size_t i = 0; i < deformed.size(); ++i) deformed[i] = blended(deformed[i], skin[i], carried);
  return deformed;
}

}  // namespace pliant
