#include "framework/problem/structure.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "framework/core/error.h"
#include "framework/problem/lever_arms.cl.embed.h"

namespace pliant {

// Plain pointers and counting sorts: this runs whenever constraints are chosen anew.
NodeLists list_by_node(const Incidences& incidences, int node_count) {
  NodeLists lists;
  lists.starts.assign(static_cast<std::size_t>(node_count) + 1, 0);
  int* starts = lists.starts.data();
  for (const int node : incidences.nodes)
    if (node >= 0) ++starts[node + 1];
  for (int node = 0; node < node_count; ++node) starts[node + 1] += starts[node];
  lists.entries.resize(static_cast<std::size_t>(starts[node_count]));
  std::vector<int> next(lists.starts.begin(), lists.starts.end() - 1);
  const int* node = incidences.nodes.data();
  int* entries = lists.entries.data();
  const auto instances = static_cast<int>(incidences.size());
  for (int instance = 0; instance < instances; ++instance)
    for (int slot = 0; slot < incidences.per_instance; ++slot, ++node)
      if (*node >= 0) entries[next[static_cast<std::size_t>(*node)]++] = instance * max_influences + slot;
  return lists;
}

BlockPattern find_blocks(const std::vector<const Incidences*>& incidences,
                         const std::vector<const NodeLists*>& lists, int node_count) {
  BlockPattern pattern;
  pattern.starts.reserve(static_cast<std::size_t>(node_count) + 1);
  pattern.columns.reserve(32 * static_cast<std::size_t>(node_count));
  pattern.places.resize(lists.size());
  for (std::size_t kind = 0; kind < lists.size(); ++kind)
    pattern.places[kind].resize(lists[kind]->entries.size() *
                                static_cast<std::size_t>(incidences[kind]->per_instance));
  struct Found {
    int row = -1;
    int place = 0;
  };
  std::vector<Found> found(static_cast<std::size_t>(node_count));
  for (int row = 0; row < node_count; ++row) {
    const auto start = pattern.columns.size();
    pattern.starts.push_back(static_cast<int>(start));
    pattern.columns.push_back(row);
    found[static_cast<std::size_t>(row)] = {row, 0};
    for (std::size_t kind = 0; kind < lists.size(); ++kind) {
      const int k = incidences[kind]->per_instance;
      const int* entry = lists[kind]->entries.data() + lists[kind]->starts[static_cast<std::size_t>(row)];
      const int* end = lists[kind]->entries.data() + lists[kind]->starts[static_cast<std::size_t>(row) + 1];
      std::uint16_t* place = pattern.places[kind].data() + k * (entry - lists[kind]->entries.data());
      for (; entry != end; ++entry) {
        const int* node = incidences[kind]->nodes.data() + *entry / max_influences * k;
        for (int slot = 0; slot < k; ++slot, ++node, ++place) {
          if (*node < 0) continue;
          Found& column = found[static_cast<std::size_t>(*node)];
          if (column.row != row) {
            column = {row, static_cast<int>(pattern.columns.size() - start)};
            pattern.columns.push_back(*node);
          }
          *place = static_cast<std::uint16_t>(column.place);
        }
      }
    }
    if (pattern.columns.size() - start > std::numeric_limits<std::uint16_t>::max())
      throw DataError(fmt::format("node {} is coupled with more than {} others", row,
                                  std::numeric_limits<std::uint16_t>::max()));
  }
  pattern.starts.push_back(static_cast<int>(pattern.columns.size()));
  return pattern;
}

namespace {

/// Calls visit(entry, slot, column) for whatever of one kind of instances falls on `row` of the lower
/// triangle.
template <class Visit>
void for_each_in_row(int row, const Incidences& incidences, const NodeLists& lists, const Visit& visit) {
  const int k = incidences.per_instance;
  const int* entry = lists.entries.data() + lists.starts[static_cast<std::size_t>(row)];
  const int* end = lists.entries.data() + lists.starts[static_cast<std::size_t>(row) + 1];
  for (; entry != end; ++entry) {
    const int* node = incidences.nodes.data() + *entry / max_influences * k;
    for (int slot = 0; slot < k; ++slot)
      if (node[slot] >= 0 && node[slot] <= row) visit(*entry, slot, static_cast<std::size_t>(node[slot]));
  }
}

}  // namespace

LowerBlocks find_lower_blocks(const std::vector<const Incidences*>& incidences,
                              const std::vector<const NodeLists*>& lists, int node_count) {
  LowerBlocks blocks;
  blocks.contributions.resize(lists.size());
  for (auto& contributions : blocks.contributions) contributions.starts.push_back(0);
  std::vector<int> block_of(static_cast<std::size_t>(node_count), -1);  // below `first`: not in this row
  std::vector<int> next;
  for (int row = 0; row < node_count; ++row) {
    const auto first = static_cast<int>(blocks.columns.size());
    const auto note = [&](int, int, std::size_t column) {
      if (std::exchange(block_of[column], first) < first) blocks.columns.push_back(static_cast<int>(column));
    };
    note(0, 0, static_cast<std::size_t>(row));
    for (std::size_t kind = 0; kind < lists.size(); ++kind)
      for_each_in_row(row, *incidences[kind], *lists[kind], note);
    std::sort(blocks.columns.begin() + first, blocks.columns.end());
    const auto end = static_cast<int>(blocks.columns.size());
    for (int block = first; block < end; ++block)
      block_of[static_cast<std::size_t>(blocks.columns[static_cast<std::size_t>(block)])] = block;
    blocks.rows.resize(blocks.columns.size(), row);
    blocks.diagonal.push_back(end - 1);

    // A counting sort per kind: how many for each block, where each block's begin, then fill.
    for (std::size_t kind = 0; kind < lists.size(); ++kind) {
      auto& starts = blocks.contributions[kind].starts;
      auto& entries = blocks.contributions[kind].entries;
      next.assign(static_cast<std::size_t>(end - first), 0);
      for_each_in_row(row, *incidences[kind], *lists[kind], [&](int, int, std::size_t column) {
        ++next[static_cast<std::size_t>(block_of[column] - first)];
      });
      for (int& place : next) {
        const int count = std::exchange(place, starts.back());
        starts.push_back(starts.back() + count);
      }
      entries.resize(static_cast<std::size_t>(starts.back()));
      for_each_in_row(row, *incidences[kind], *lists[kind], [&](int entry, int slot, std::size_t column) {
        int& place = next[static_cast<std::size_t>(block_of[column] - first)];
        entries[static_cast<std::size_t>(place++)] = entry * max_influences + slot;
      });
    }
  }
  return blocks;
}

void compute_lever_arms(Device& device, const Constraints& constraints, const Array<float>& node_points,
                        int first, int per_instance, const Buffer& lever_arms) {
  auto kernel = device.kernel(embedded::framework_problem_lever_arms_cl, "lever_arms_of_constraints");
  const auto& influences = constraints.influences;
  device.run("weights", kernel, constraints.size(), 64, constraints.points.device(device),
             static_cast<cl_int>(constraints.size()), static_cast<cl_int>(influences.per_point),
             influences.nodes.device(device), influences.weights.device(device), node_points.device(device),
             static_cast<cl_int>(first), static_cast<cl_int>(per_instance), lever_arms);
}

Incidences edge_incidences(const DeformationGraph& graph) {
  Incidences incidences{2, {}};
  incidences.nodes.resize(2 * graph.edges.size());
  int* node = incidences.nodes.data();
  for (const auto& edge : graph.edges) {
    *node++ = edge.from;
    *node++ = edge.to;
  }
  return incidences;
}

}  // namespace pliant
