#include "framework/io/gltf_skin.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace pliant {
namespace {

using Json = GltfDocument::Json;

/// Puts a share among the four largest of a vertex, the largest first; of equal ones the first named stays.
void keep_largest(GltfJoints::Share share, GltfJoints::Shares& largest) {
  for (GltfJoints::Share& kept : largest)
    if (share.first > kept.first) std::swap(share, kept);
}

}  // namespace

GltfJoints::GltfJoints(const GltfDocument& document, const std::vector<GltfNode>& nodes, double unit)
    : document_(document), unit_(unit), is_bound_(nodes.size(), false) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    joints_.push_back(
        {nodes[i].name, nodes[i].parent, in_millimetres(nodes[i].local), Eigen::Affine3d::Identity()});
    position_[nodes[i].number] = static_cast<int>(i);
  }
}

Eigen::Affine3d GltfJoints::in_millimetres(Eigen::Affine3d transform) const {
  transform.translation() *= unit_;
  return transform;
}

/// The joint of a node that takes points of a mesh by `joint_from_mesh`. What was bound in several ways to
/// one node is carried by joints of its own that stay with the node's.
int GltfJoints::bound(std::size_t node, const Eigen::Affine3d& joint_from_mesh) {
  if (!is_bound_[node]) {
    is_bound_[node] = true;
    joints_[node].joint_from_mesh = joint_from_mesh;
    return static_cast<int>(node);
  }
  if (joints_[node].joint_from_mesh.matrix() == joint_from_mesh.matrix()) return static_cast<int>(node);
  joints_.push_back({fmt::format("{}#{}", joints_[node].name, joints_.size()), static_cast<int>(node),
                     Eigen::Affine3d::Identity(), joint_from_mesh});
  return static_cast<int>(joints_.size()) - 1;
}

JointWeights GltfJoints::carried_by(std::size_t node) {
  JointWeights weights;
  weights.joints[0] = bound(node, Eigen::Affine3d::Identity());
  weights.weights[0] = 1;
  return weights;
}

std::vector<Eigen::Affine3d> GltfJoints::inverse_bind_matrices(std::size_t skin, std::size_t count) const {
  std::vector<Eigen::Affine3d> matrices(count, Eigen::Affine3d::Identity());
  const Json& description = document_.element("skins", skin);
  if (document_.find(description, "inverseBindMatrices") == nullptr) return matrices;
  const std::vector<float> numbers = document_.reals(document_.integer(description, "inverseBindMatrices"),
                                                     "MAT4", GltfDocument::Numbers::floats);
  if (numbers.size() < 16 * count)
    document_.fail(
        fmt::format("skin {} has {} inverse bind matrices for {} joints", skin, numbers.size() / 16, count));
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4f>(&numbers[16 * i]).cast<double>();
    // Some write rounded numbers into the last row.
    constexpr double kTolerance = 1e-4;
    if (!((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() < kTolerance))
      document_.fail(fmt::format("inverse bind matrix {} of skin {} is not affine", i, skin));
    matrices[i].affine() = matrix.topRows<3>();
    if (!(std::abs(matrices[i].linear().determinant()) > 0))
      document_.fail(fmt::format("inverse bind matrix {} of skin {} cannot be inverted", i, skin));
    matrices[i] = in_millimetres(matrices[i]);
  }
  return matrices;
}

const std::vector<int>& GltfJoints::joints_of(std::size_t skin) {
  const auto known = skins_.find(skin);
  if (known != skins_.end()) return known->second;
  const auto& list = document_.list(document_.element("skins", skin), "joints");
  if (list.empty()) document_.fail(fmt::format("skin {} has no joints", skin));
  const std::vector<Eigen::Affine3d> matrices = inverse_bind_matrices(skin, list.size());
  std::vector<int> joints;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t number = document_.index(list[i], "joint");
    document_.element("nodes", number);
    const auto node = position_.find(number);
    if (node == position_.end())
      document_.fail(
          fmt::format("joint {} of skin {} is node {}, which the scene does not have", i, skin, number));
    joints.push_back(bound(static_cast<std::size_t>(node->second), matrices[i]));
  }
  return skins_.emplace(skin, std::move(joints)).first->second;
}

JointWeights GltfJoints::to_weights(const Shares& largest, const std::vector<int>& joints,
                                    std::size_t vertex) const {
  float sum = 0;
  for (const auto& [share, joint] : largest) sum += share;
  if (!(sum > 0)) document_.fail(fmt::format("the weights of skinned vertex {} are all zero", vertex));
  JointWeights weights;
  for (std::size_t k = 0; k < largest.size(); ++k) {
    const auto [share, joint] = largest[k];
    if (share == 0) break;
    if (joint >= joints.size())
      document_.fail(
          fmt::format("skinned vertex {} names joint {}, but its skin has {}", vertex, joint, joints.size()));
    weights.joints[static_cast<int>(k)] = joints[joint];
    weights.weights[static_cast<int>(k)] = share / sum;
  }
  return weights;
}

std::vector<JointWeights> GltfJoints::read_weights(const Json& primitive, std::size_t skin,
                                                   std::size_t count) {
  const std::vector<int>& joints = joints_of(skin);
  const Json& attributes = document_.at(primitive, "attributes");
  std::vector<Shares> shares(count);
  for (int set = 0;; ++set) {
    const std::string joints_key = fmt::format("JOINTS_{}", set);
    const std::string weights_key = fmt::format("WEIGHTS_{}", set);
    if (set > 0 && document_.find(attributes, joints_key.c_str()) == nullptr) break;
    const auto indices = document_.indices(document_.integer(attributes, joints_key.c_str()), "VEC4");
    const auto weights = document_.reals(document_.integer(attributes, weights_key.c_str()), "VEC4",
                                         GltfDocument::Numbers::normalised);
    if (indices.size() != 4 * count || weights.size() != 4 * count)
      document_.fail(fmt::format("{} joints and {} weights of a skin for {} vertices", indices.size() / 4,
                                 weights.size() / 4, count));
    for (std::size_t i = 0; i < 4 * count; ++i) {
      if (weights[i] < 0) document_.fail(fmt::format("a weight of skinned vertex {} is negative", i / 4));
      keep_largest({weights[i], indices[i]}, shares[i / 4]);
    }
  }
  std::vector<JointWeights> all;
  for (std::size_t vertex = 0; vertex < count; ++vertex)
    all.push_back(to_weights(shares[vertex], joints, vertex));
  return all;
}

}  // namespace pliant
