#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "framework/geometry/animation.h"
#include "framework/io/gltf_document.h"

namespace pliant {

/// A node of the scene that a glTF file shows. Transforms are in the file's unit.
struct GltfNode {
  std::size_t number = 0;                                ///< in the file's list
  int parent = -1;                                       ///< in the list of nodes, before this one; -1: none
  std::string name;                                      ///< unlike all others
  Eigen::Affine3d local = Eigen::Affine3d::Identity();   ///< from its frame to its parent's
  Eigen::Affine3d placed = Eigen::Affine3d::Identity();  ///< from its frame to the scene's
};

/// The nodes of the default scene, or all where there is no scene, parents before their children. Throws
/// DataError naming the file when they form no forest or a transform is none.
std::vector<GltfNode> read_nodes(const GltfDocument& document);

/// How a node stands while nothing moves it, as an animation takes it, in the file's unit. Throws DataError
/// for a node with a matrix, which has no such parts.
JointMotion resting_motion(const GltfDocument& document, const GltfNode& node);

/// Builds chains of nodes that are children of one node, by their names (chained_parents); gives how many got
/// another parent. None of them changes its place. `may_move` tells of each node whether it may.
int chain_nodes(const GltfDocument& document, const std::vector<bool>& may_move,
                std::vector<GltfNode>& nodes);

}  // namespace pliant
