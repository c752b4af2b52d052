#pragma once

#include "framework/core/registry.h"
#include "framework/deformation/graph_builder.h"

namespace pliant {

/// A quadtree over the projection of the source, whose leaves are the nodes of the graph [thesis 4.3].
///
/// The root is the square around the bounding box of the projection; level l divides it into 4^l cells. A
/// leaf has its node at the point seen at the centre of its cell (point_at of pixel_index.h). A leaf with
/// points, but none there, is virtual: it has no node, and the tree may grow in it. Below `virtual_levels`
/// there are none of these: there such a cell is not part of the tree, and its points hang on the nodes
/// around it. No cell loses all of its nodes: it is not divided where that would take away its node and give
/// none, and a virtual one does not take back children with nodes.
class QuadtreeGraph : public GraphBuilder {
 public:
  struct Settings {
    int levels = 5;                 ///< deepest level; fewer where a cell would be smaller than a pixel
    int initial_levels = 3;         ///< of the tree to begin with; collapsing never goes above
    int virtual_levels = 10;        ///< on which there are virtual leaves; 2 in the thesis
    double refine_threshold = 2;    ///< mm of mean residual in a cell
    double collapse_threshold = 1;  ///< mm, below refine_threshold
  };

  /// Throws ConfigError for settings that contradict each other.
  explicit QuadtreeGraph(const Settings& settings);

  /// The tree of `initial_levels` [Alg. 1]. Adapting it refines [Alg. 2], each leaf once, then collapses
  /// bottom-up [Alg. 3]. Were the children judged by the same residual at once, a poor first fit would grow
  /// the whole tree.
  std::unique_ptr<NodeSelection> select_nodes(Device& device, const SurfaceView& source) const override;

 private:
  Settings settings_;
};

/// Adds the graph `quadtree`.
void register_quadtree_graph(Registry& registry);

}  // namespace pliant
