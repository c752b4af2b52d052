#include "framework/deformation/skinning.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "framework/core/error.h"
#include "framework/deformation/pick_weights.cl.embed.h"
#include "framework/deformation/skinning.cl.embed.h"

namespace pliant {
namespace {

/// How many nodes move each point: `k`, or all there are.
int checked_nearest(std::size_t node_count, int k) {
  if (k < 1 || k > max_influences)
    throw DataError(fmt::format("{} nodes per point asked for; 1 to {} are possible", k, max_influences));
  if (node_count == 0) throw DataError("the graph has no node");
  return static_cast<int>(std::min(node_count, static_cast<std::size_t>(k)));
}

/// The points that each node moves: those of node j are points[first[j]] to before points[first[j + 1]].
struct NodeMembers {
  std::vector<std::size_t> first;
  std::vector<std::size_t> points;
};

/// Most points are told apart by this: the size that is usual is known when it is compiled.
bool are_same(const int* nodes, const int* others, std::size_t count) {
  return count == 4 ? std::memcmp(nodes, others, 4 * sizeof(int)) == 0
                    : std::equal(nodes, nodes + count, others);
}

/// Whether each of `nodes` is one of `others`, of as many.
bool are_among(const int* nodes, const int* others, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (nodes[i] != others[i] && std::find(others, others + count, nodes[i]) == others + count) return false;
  return true;
}

/// A point that is moved by the same nodes as the one before it, in whatever order, tells no new edge and is
/// left out: most are.
NodeMembers members_of_nodes(const std::vector<int>& nodes, std::size_t k, std::size_t node_count) {
  std::vector<std::size_t> telling;
  std::vector<std::size_t> first(node_count + 1, 0);
  const int* last = nullptr;
  for (std::size_t entry = 0; entry + k <= nodes.size(); entry += k) {
    const int* point = nodes.data() + entry;
    if (entry > 0 && (are_same(point - k, point, k) || are_among(point, last, k))) continue;
    last = point;
    telling.push_back(entry / k);
    for (std::size_t slot = 0; slot < k; ++slot) ++first[static_cast<std::size_t>(nodes[entry + slot]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::size_t> points(telling.size() * k);
  std::vector<std::size_t> next = first;
  for (const std::size_t point : telling)
    for (std::size_t slot = 0; slot < k; ++slot)
      points[next[static_cast<std::size_t>(nodes[k * point + slot])]++] = point;
  return {std::move(first), std::move(points)};
}

constexpr std::size_t group_size = 16;  // GROUP in skinning.cl
constexpr float far_away = 1e18F;       // its square is still finite

/// Orders `nodes` so that each group_size of them from the first on lie together: halves of the widest
/// extent.
void order_by_place(const std::vector<Eigen::Vector3f>& nodes, std::vector<int>::iterator first,
                    std::vector<int>::iterator last) {
  const auto count = static_cast<std::size_t>(last - first);
  if (count <= group_size) return;
  Eigen::AlignedBox3f box;
  for (auto node = first; node != last; ++node) box.extend(nodes[static_cast<std::size_t>(*node)]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto place = [&](int node) { return std::pair(nodes[static_cast<std::size_t>(node)][axis], node); };
  const std::size_t groups = (count + group_size - 1) / group_size;
  const auto middle = first + static_cast<std::ptrdiff_t>(groups / 2 * group_size);
  std::nth_element(first, middle, last, [&](int a, int b) { return place(a) < place(b); });
  order_by_place(nodes, first, middle);
  order_by_place(nodes, middle, last);
}

/// Nodes as the kernel wants them; see skinning.cl.
struct GroupedNodes {
  std::size_t groups = 0;
  Array<float> rows;
  Array<int> ids;
  Array<float> boxes;
};

GroupedNodes group_nodes(const std::vector<Eigen::Vector3f>& nodes) {
  std::vector<int> ids(nodes.size());
  std::iota(ids.begin(), ids.end(), 0);
  order_by_place(nodes, ids.begin(), ids.end());
  const std::size_t groups = (nodes.size() + group_size - 1) / group_size;
  const std::size_t stride = groups * group_size;
  std::vector<float> rows(3 * stride, far_away);
  std::vector<float> boxes(6 * groups);
  for (std::size_t place = 0; place < nodes.size(); ++place) {
    const Eigen::Vector3f& node = nodes[static_cast<std::size_t>(ids[place])];
    const bool is_first = place % group_size == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float value = node[static_cast<Eigen::Index>(axis)];
      rows[axis * stride + place] = value;
      float& low = boxes[axis * groups + place / group_size];
      float& high = boxes[(3 + axis) * groups + place / group_size];
      low = is_first ? value : std::min(low, value);
      high = is_first ? value : std::max(high, value);
    }
  }
  ids.resize(stride, std::numeric_limits<int>::max());
  return {groups, Array<float>(std::move(rows)), Array<int>(std::move(ids)), Array<float>(std::move(boxes))};
}

}  // namespace

Influences compute_influences(Device& device, const Array<float>& points,
                              const std::vector<Eigen::Vector3f>& nodes, int nearest) {
  const int k = checked_nearest(nodes.size(), nearest);
  const GroupedNodes grouped = group_nodes(nodes);
  const auto point_count = points.size() / 3;
  const auto entries = point_count * static_cast<std::size_t>(k);
  Influences influences{k, Array<int>(entries), Array<float>(entries)};
  auto kernel = device.kernel(embedded::framework_deformation_skinning_cl, "influences",
                              fmt::format("-DK={} -DGROUP={} -DHAS_NEXT={}", k, group_size,
                                          static_cast<int>(nodes.size() > static_cast<std::size_t>(k))));
  const auto width = static_cast<std::size_t>(device.width());
  device.run("weights", kernel, (point_count + width - 1) / width, 64 / width, points.device(device),
             static_cast<cl_int>(point_count), grouped.rows.device(device),
             static_cast<cl_int>(group_size * grouped.groups), grouped.ids.device(device),
             grouped.boxes.device(device), static_cast<cl_int>(grouped.groups),
             influences.nodes.write_device(device), influences.weights.write_device(device));
  return influences;
}

Influences pick_influences(Device& device, const Influences& influences, const Array<int>& points) {
  const auto k = static_cast<std::size_t>(influences.per_point);
  std::vector<int> nodes;
  nodes.reserve(k * points.size());
  for (const int point : points.host()) {
    const int* first = influences.nodes.host().data() + k * static_cast<std::size_t>(point);
    nodes.insert(nodes.end(), first, first + k);
  }
  Array<float> weights(nodes.size());
  auto kernel = device.kernel(embedded::framework_deformation_pick_weights_cl, "pick_weights");
  device.run("weights", kernel, nodes.size(), 64, static_cast<cl_int>(nodes.size()), influences.per_point,
             points.device(device), influences.weights.device(device), weights.write_device(device));
  return {influences.per_point, Array<int>(std::move(nodes)), std::move(weights)};
}

Influences compute_influences_reference(const std::vector<float>& points,
                                        const std::vector<Eigen::Vector3f>& nodes, int nearest) {
  const int k = checked_nearest(nodes.size(), nearest);
  const auto neighbours = static_cast<std::size_t>(k);
  std::vector<int> found;
  std::vector<float> weights;
  std::vector<std::size_t> order(nodes.size());
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    const Eigen::Vector3f point(points[i], points[i + 1], points[i + 2]);
    const auto distance = [&](std::size_t j) { return (nodes[j] - point).norm(); };
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
    const float farthest =
        nodes.size() > neighbours ? distance(order[neighbours]) : 2 * distance(order.back());
    std::vector<float> closeness(neighbours, 0);
    for (std::size_t slot = 0; slot < neighbours && farthest > 0; ++slot)
      closeness[slot] = std::pow(1 - distance(order[slot]) / farthest, 2.0F);
    const float sum = std::accumulate(closeness.begin(), closeness.end(), 0.0F);
    for (std::size_t slot = 0; slot < neighbours; ++slot) {
      found.push_back(static_cast<int>(order[slot]));
      weights.push_back(sum > 0 ? closeness[slot] / sum : 1.0F / static_cast<float>(k));
    }
  }
  return {k, Array<int>(std::move(found)), Array<float>(std::move(weights))};
}

std::vector<Edge> find_edges(const Influences& influences, int node_count) {
  const auto& nodes = influences.nodes.host();
  const auto k = static_cast<std::size_t>(influences.per_point);
  const NodeMembers members = members_of_nodes(nodes, k, static_cast<std::size_t>(node_count));
  std::vector<Edge> edges;
  std::vector<int> seen_from(static_cast<std::size_t>(node_count), -1);
  for (int from = 0; from < node_count; ++from) {
    const auto first_edge = static_cast<std::ptrdiff_t>(edges.size());
    seen_from[static_cast<std::size_t>(from)] = from;
    const auto node = static_cast<std::size_t>(from);
    for (std::size_t i = members.first[node]; i < members.first[node + 1]; ++i)
      for (std::size_t slot = 0; slot < k; ++slot) {
        const int to = nodes[k * members.points[i] + slot];
        if (std::exchange(seen_from[static_cast<std::size_t>(to)], from) != from) edges.push_back({from, to});
      }
    std::sort(edges.begin() + first_edge, edges.end(),
              [](const Edge& a, const Edge& b) { return a.to < b.to; });
  }
  return edges;
}

}  // namespace pliant
