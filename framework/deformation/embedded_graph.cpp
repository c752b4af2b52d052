#include "framework/deformation/embedded_graph.h"

#include <fmt/format.h>

#include "framework/core/error.h"
#include "framework/geometry/point_set.h"

namespace pliant {

EmbeddedGraph embed_graph(Device& device, const NodeSelection& selection, const PointSet& points,
                          int nearest_nodes, const std::string& name) {
  EmbeddedGraph graph;
  graph.nodes = selection.points();
  if (graph.nodes.empty())
    throw DataError(fmt::format("{}: no node of the graph falls on the source; choose a finer one", name));
  graph.cells = selection.cells();
  graph.node_points = std::move(pick_points(device, points, Array<int>(graph.nodes)).points);
  graph.positions = unflatten(graph.node_points);
  graph.influences = compute_influences(device, points.points, graph.positions, nearest_nodes);
  graph.influences.nodes.fetch();
  return graph;
}

void connect(EmbeddedGraph& graph, StageTimes& times) {
  graph.influences.nodes.host();  // waits here for the device: its "weights" are not the time of "edges"
  graph.edges = timed(times, "edges",
                      [&] { return find_edges(graph.influences, static_cast<int>(graph.nodes.size())); });
}

}  // namespace pliant
