#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "framework/geometry/animation.h"
#include "framework/io/gltf_document.h"
#include "framework/io/gltf_nodes.h"

namespace pliant {

/// Of each node of the list: whether an animation of the file moves it, turns it or scales it.
std::vector<bool> moved_nodes(const GltfDocument& document, const std::vector<GltfNode>& nodes);

/// The animations of a file, in its order, for joints that are its nodes, lengths times `unit` in mm.
/// `targets`: which of the mesh's morph targets those of a node of the file's list are. What moves nodes that
/// the scene does not show is left out. Throws DataError naming the file and what is wrong.
std::vector<Animation> read_animations(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                                       const std::map<std::size_t, std::vector<std::size_t>>& targets,
                                       double unit);

}  // namespace pliant
