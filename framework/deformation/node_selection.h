#pragma once

#include <vector>

#include "framework/geometry/point_selection.h"

namespace pliant {

/// The pixels of the source that a node of a hierarchical graph stands for: columns left to right - 1 of
/// rows top to bottom - 1. Cells at the rim may reach beyond the image.
struct GraphCell {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
  int level = 1;            ///< 1 the coarsest
  bool is_virtual = false;  ///< there is no point at its centre, hence no node
  bool operator==(const GraphCell&) const = default;
};

/// Points of a surface that are the nodes of its deformation graph.
class NodeSelection : public PointSelection {
 public:
  /// The cells of the nodes, and the virtual ones, without overlap; empty where nodes have no cells.
  virtual std::vector<GraphCell> cells() const { return {}; }
};

}  // namespace pliant
