#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/deformation/node_selection.h"
#include "framework/geometry/image.h"

namespace pliant {

/// A deformation graph over the depth that it was built on.
struct GraphDrawing {
  Image<float> depth;                  ///< mm, NaN where there is none
  std::vector<GraphCell> cells;        ///< may be empty
  std::vector<Eigen::Vector2d> nodes;  ///< pixels
};

/// Cells in the colour of their level, virtual ones crossed out, and a dot at each node, as a PNG of no more
/// than the square around the depth.
std::vector<std::uint8_t> draw_graph(const GraphDrawing& graph, const std::string& title,
                                     const std::string& subtitle);

}  // namespace pliant
