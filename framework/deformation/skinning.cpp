#include "framework/deformation/skinning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "framework/core/error.h"
#include "framework/deformation/skinning.cl.embed.h"

namespace pliant {
namespace {

void check(std::size_t node_count, int k) {
  if (k < 1 || k > max_influences)
    throw DataError(fmt::format("{} nodes per point asked for; 1 to {} are possible", k, max_influences));
  if (node_count < static_cast<std::size_t>(k) + 1)
    throw DataError(
        fmt::format("the graph has {} node(s); weights over the {} nearest need at least {}: "
                    "choose a finer graph or fewer nearest nodes",
                    node_count, k, k + 1));
}

}  // namespace

Influences compute_influences(Device& device, const Array<float>& points,
                              const std::vector<Eigen::Vector3f>& nodes, int k) {
  check(nodes.size(), k);
  const auto width = static_cast<std::size_t>(device.width());
  const auto stride = (nodes.size() + width - 1) / width * width;
  constexpr float far_away = 1e18F;  // its square is still finite
  std::vector<float> rows(3 * stride, far_away);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    for (std::size_t axis = 0; axis < 3; ++axis) rows[axis * stride + j] = nodes[j][static_cast<int>(axis)];
  const Array<float> node_rows(std::move(rows));

  const auto point_count = points.size() / 3;
  const auto entries = point_count * static_cast<std::size_t>(k);
  Influences influences{k, Array<int>(entries), Array<float>(entries)};
  auto kernel =
      device.kernel(embedded::framework_deformation_skinning_cl, "influences", fmt::format("-DK={}", k));
  device.run("weights", kernel, point_count, 64, points.device(device), static_cast<cl_int>(point_count),
             node_rows.device(device), static_cast<cl_int>(stride), influences.nodes.write_device(device),
             influences.weights.write_device(device));
  return influences;
}

Influences compute_influences_reference(const std::vector<float>& points,
                                        const std::vector<Eigen::Vector3f>& nodes, int k) {
  check(nodes.size(), k);
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
    const float farthest = distance(order[neighbours]);
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
  std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(node_count));
  const auto connect = [&](int from, int to) {
    auto& list = neighbours[static_cast<std::size_t>(from)];
    if (std::find(list.begin(), list.end(), to) == list.end()) list.push_back(to);
  };
  for (std::size_t point = 0; point + k <= nodes.size(); point += k)
    for (std::size_t a = 0; a < k; ++a)
      for (std::size_t b = 0; b < k; ++b)
        if (a != b) connect(nodes[point + a], nodes[point + b]);

  std::vector<Edge> edges;
  for (int from = 0; from < node_count; ++from) {
    auto& list = neighbours[static_cast<std::size_t>(from)];
    std::sort(list.begin(), list.end());
    for (const int to : list) edges.push_back({from, to});
  }
  return edges;
}

}  // namespace pliant
