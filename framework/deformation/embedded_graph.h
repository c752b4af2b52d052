#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/core/stopwatch.h"
#include "framework/deformation/graph.h"
#include "framework/deformation/node_selection.h"
#include "framework/deformation/skinning.h"
#include "framework/geometry/point_set.h"

namespace pliant {

/// A deformation graph embedded in a set of points [Sumner et al. 2007]: its nodes are some of them, and each
/// point is moved by the nodes nearest to it.
struct EmbeddedGraph {
  std::vector<int> nodes;                  ///< indices of points
  std::vector<Eigen::Vector3f> positions;  ///< of the nodes at rest, mm
  Array<float> node_points;                ///< the positions again, x y z each, for the device
  Influences influences;                   ///< of every point
  std::vector<Edge> edges;
  std::vector<GraphCell> cells;  ///< of the nodes, where they have some
};

/// A graph without edges yet: the host need not wait for the influences before it has something to do with
/// them. `points`: mm. `name` of the points is for the DataError when no node is selected.
EmbeddedGraph embed_graph(Device& device, const NodeSelection& selection, const PointSet& points,
                          int nearest_nodes, const std::string& name);

/// Waits for the influences and finds the edges. Adds to `times` what the host spent on "edges".
void connect(EmbeddedGraph& graph, StageTimes& times);

}  // namespace pliant
