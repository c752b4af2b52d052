#include "framework/deformation/embedded_graph.h"

#include <fmt/format.h>

#include "framework/core/error.h"
#include "framework/geometry/point_set.h"

namespace pliant {

EmbeddedGraph embed_graph(Device& device, const NodeSelection& selection,
                          const std::vector<Eigen::Vector3f>& points, const Array<float>& device_points,
                          int nearest_nodes, const std::string& name, StageTimes& times) {
  EmbeddedGraph graph;
  graph.nodes = selection.points();
  if (graph.nodes.empty())
    throw DataError(fmt::format("{}: no node of the graph falls on the source; choose a finer one", name));
  graph.cells = selection.cells();
  for (const int node : graph.nodes) graph.positions.push_back(points[static_cast<std::size_t>(node)]);
  graph.node_points = flatten(graph.positions);
  graph.influences = compute_influences(device, device_points, graph.positions, nearest_nodes);
  graph.influences.nodes.host();  // waits here for the device: its "weights" are not the time of "edges"
  graph.edges = timed(times, "edges",
                      [&] { return find_edges(graph.influences, static_cast<int>(graph.nodes.size())); });
  return graph;
}

}  // namespace pliant
