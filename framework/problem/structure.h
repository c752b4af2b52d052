#pragma once

#include <cstdint>
#include <vector>

#include "framework/problem/problem.h"

namespace pliant {

/// Instances of terms and the nodes that each looks at: `nodes` holds `per_instance` of them an instance;
/// -1 marks a slot that is empty.
struct Incidences {
  int per_instance = 0;
  std::vector<int> nodes;
  std::size_t size() const {
    return per_instance == 0 ? 0 : nodes.size() / static_cast<std::size_t>(per_instance);
  }
};

/// For each node the slots that name it, in the order of the instances. An entry is
/// instance * max_influences + slot.
struct NodeLists {
  std::vector<int> starts;  ///< one more than nodes
  std::vector<int> entries;
};
NodeLists list_by_node(const Incidences& incidences, int node_count);

/// Which blocks (pairs of nodes) of J^T J are not zero by structure, row by row. The first block of a row
/// is its diagonal.
struct BlockPattern {
  std::vector<int> starts;   ///< one more than nodes
  std::vector<int> columns;  ///< node of each block
  /// Per kind of instances, entry of its NodeLists and slot of the entry's instance: the place, counted from
  /// the start of the row, of the block that couples the entry's node with that slot's.
  std::vector<std::vector<std::uint16_t>> places;
};
BlockPattern find_blocks(const std::vector<const Incidences*>& incidences,
                         const std::vector<const NodeLists*>& lists, int node_count);

/// The same for the lower triangle alone, block by block.
struct LowerBlocks {
  std::vector<int> rows;  ///< of each block, with row >= column, sorted by row, then by column
  std::vector<int> columns;
  std::vector<int> diagonal;  ///< of each node, which block
  /// Per kind of instances and block: who contributes, as (instance * max_influences + slot of the row's
  /// node)
  /// * max_influences + slot of the column's node.
  struct Contributions {
    std::vector<int> starts;  ///< one more than blocks
    std::vector<int> entries;
  };
  std::vector<Contributions> contributions;
};
LowerBlocks find_lower_blocks(const std::vector<const Incidences*>& incidences,
                              const std::vector<const NodeLists*>& lists, int node_count);

/// What the edges of a graph look at: `from`, then `to`.
Incidences edge_incidences(const DeformationGraph& graph);

/// Writes the lever_arms of constraints into `lever_arms`, from instance `first` on, `per_instance` float4 an
/// instance: for each slot w (p - g, 1), by which the rows of the node's [D | t] move the point; empty slots
/// get zeros.
void compute_lever_arms(Device& device, const Constraints& constraints, const Array<float>& node_points,
                        int first, int per_instance, const Buffer& lever_arms);

}  // namespace pliant
