#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "framework/geometry/mesh.h"
#include "framework/io/gltf_document.h"
#include "framework/io/gltf_nodes.h"

namespace pliant {

/// Makes joints of the nodes of a glTF file, and says which of them carry what. Lengths of the file times
/// `unit` are mm. Throws DataError naming the file and what is wrong.
class GltfJoints {
 public:
  using Share = std::pair<float, std::uint32_t>;  ///< a weight, and which of the skin's joints has it
  using Shares = std::array<Share, 4>;

  /// A joint for every node, in their order. The document must outlive this.
  GltfJoints(const GltfDocument& document, const std::vector<GltfNode>& nodes, double unit);

  /// Weights of a vertex that a node carries as it is.
  JointWeights carried_by(std::size_t node);
  /// Weights of the vertices of a primitive, so many as `count`, that are bound to a skin.
  std::vector<JointWeights> read_weights(const GltfDocument::Json& primitive, std::size_t skin,
                                         std::size_t count);

  const std::vector<Joint>& joints() const { return joints_; }

 private:
  const std::vector<int>& joints_of(std::size_t skin);
  std::vector<Eigen::Affine3d> inverse_bind_matrices(std::size_t skin, std::size_t count) const;
  int bound(std::size_t node, const Eigen::Affine3d& joint_from_mesh);
  Eigen::Affine3d in_millimetres(Eigen::Affine3d transform) const;
  JointWeights to_weights(const Shares& largest, const std::vector<int>& joints, std::size_t vertex) const;

  const GltfDocument& document_;
  double unit_;
  std::vector<Joint> joints_;
  std::vector<bool> is_bound_;           // of each node: whether its joint carries something already
  std::map<std::size_t, int> position_;  // of a node of the file in the list of nodes
  std::map<std::size_t, std::vector<int>> skins_;  // by number: joints in the skin's order
};

}  // namespace pliant
