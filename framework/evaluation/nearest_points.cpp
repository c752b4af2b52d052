#include "framework/evaluation/nearest_points.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "framework/geometry/surface.h"

namespace pliant {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int none = -1;
constexpr std::size_t packets_at_once = 64;  // of which a thread is given so many

struct Box {
  Eigen::Vector3f lowest = Eigen::Vector3f::Constant(infinity);
  Eigen::Vector3f highest = Eigen::Vector3f::Constant(-infinity);
};

/// Squared lengths, added up in this order wherever distances are compared. Rounding keeps order, so that the
/// distance to a box is never above that to a point inside.
template <class Values>
auto squared_length(const Values& x, const Values& y, const Values& z) {
  return x * x + y * y + z * z;
}

/// Along one axis: from where [lowest, highest] ends to where [low, high] begins, or the other way; 0 where
/// they meet.
template <class Values, class Low, class High>
Values gap(const Values& lowest, const Values& highest, const Low& low, const High& high) {
  return (lowest - high).max(low - highest).max(0.0F);
}

/// Squared distances of boxes to the box from `low` to `high`.
template <class Boxes>
auto squared_distances(const Boxes& lowest, const Boxes& highest, const Eigen::Vector3f& low,
                       const Eigen::Vector3f& high) {
  using Values = typename Boxes::value_type;
  const Values x = gap<Values>(lowest[0], highest[0], low.x(), high.x());
  const Values y = gap<Values>(lowest[1], highest[1], low.y(), high.y());
  const Values z = gap<Values>(lowest[2], highest[2], low.z(), high.z());
  return Values(squared_length(x, y, z));
}

int in_steps(int size, int step) { return (size + step - 1) / step; }

/// Gives the pieces of [0, count) to `work(first, last)` on all processors. This thread works, too, and
/// tells.
template <class Work>
void share_out(std::size_t count, std::size_t piece, const ShareSink& progress, Work work) {
  using Clock = std::chrono::steady_clock;
  std::atomic<std::size_t> next = 0;
  const auto do_one = [&] {
    const std::size_t first = next.fetch_add(piece);
    if (first < count) work(first, std::min(first + piece, count));
    return first + piece < count;
  };
  std::vector<std::jthread> helpers;
  const std::size_t most = std::min<std::size_t>(std::thread::hardware_concurrency(), count / piece);
  while (helpers.size() + 1 < most)
    helpers.emplace_back([&] {
      while (do_one()) {
      }
    });
  try {
    auto told = Clock::now();
    while (do_one()) {
      if (!progress || Clock::now() - told < std::chrono::seconds(1)) continue;
      told = Clock::now();
      progress(static_cast<double>(std::min(next.load(), count)) / static_cast<double>(count));
    }
  } catch (...) {
    next = count;
    throw;
  }
}

}  // namespace

/// Queries that go down the tree together.
struct NearestPoints::Packet {
  static constexpr int size = 64;
  using Values = Eigen::Array<float, size, 1>;

  std::array<Values, 3> query;
  Values best;  ///< squared distances, the least so far
  Box box;      ///< around the queries
  float worst;  ///< the greatest of `best`

  Eigen::Vector3f at(int i) const { return {query[0][i], query[1][i], query[2][i]}; }
};

NearestPoints::NearestPoints(const Image<Eigen::Vector3f>& map, const Camera& camera)
    : map_(map), camera_(camera) {
  Image<int> tiles = make_leaves();
  if (empty()) return;
  tiles = make_level(tiles, [&](int leaf) {
    Box box;
    for (int i = 0; i < fan; ++i) {
      const Leaf& points = leaves_[static_cast<std::size_t>(leaf)];
      const Eigen::Vector3f point(points[0][i], points[1][i], points[2][i]);
      if (!point.allFinite()) continue;
      box.lowest = box.lowest.cwiseMin(point);
      box.highest = box.highest.cwiseMax(point);
    }
    return box;
  });
  while (tiles.size() > 1)
    tiles = make_level(tiles, [&, below = levels_.size() - 1](int index) {
      const Node& node = levels_[below][static_cast<std::size_t>(index)];
      Box box;
      for (int axis = 0; axis < 3; ++axis) {
        box.lowest[axis] = node.lowest[axis].minCoeff();
        box.highest[axis] = node.highest[axis].maxCoeff();
      }
      return box;
    });
}

/// Gives the leaf of each tile, none where it has no point.
Image<int> NearestPoints::make_leaves() {
  Image<int> tiles(in_steps(map_.width(), side), in_steps(map_.height(), side), none);
  for (int row = 0; row < tiles.height(); ++row)
    for (int column = 0; column < tiles.width(); ++column) {
      Leaf leaf;
      for (Row& values : leaf) values = infinity;
      bool has_point = false;
      for (int i = 0; i < fan; ++i) {
        const int u = side * column + i % side;
        const int v = side * row + i / side;
        if (!map_.contains(u, v) || !is_point(map_(u, v))) continue;
        for (int axis = 0; axis < 3; ++axis) leaf[axis][i] = map_(u, v)[axis];
        has_point = true;
      }
      if (!has_point) continue;
      tiles(column, row) = static_cast<int>(leaves_.size());
      leaves_.push_back(leaf);
    }
  return tiles;
}

/// Makes the parents of what `below` places in tiles; gives their places.
template <class BoxOf>
Image<int> NearestPoints::make_level(const Image<int>& below, BoxOf box_of) {
  Image<int> tiles(in_steps(below.width(), side), in_steps(below.height(), side), none);
  std::vector<Node> nodes;
  for (int row = 0; row < tiles.height(); ++row)
    for (int column = 0; column < tiles.width(); ++column) {
      Node node;
      for (Row& values : node.lowest) values = infinity;
      for (Row& values : node.highest) values = -infinity;
      node.child.fill(none);
      for (int i = 0; i < fan; ++i) {
        const int u = side * column + i % side;
        const int v = side * row + i / side;
        if (!below.contains(u, v) || below(u, v) == none) continue;
        const Box box = box_of(below(u, v));
        for (int axis = 0; axis < 3; ++axis) {
          node.lowest[axis][i] = box.lowest[axis];
          node.highest[axis][i] = box.highest[axis];
        }
        node.child[i] = below(u, v);
      }
      if (*std::max_element(node.child.begin(), node.child.end()) == none) continue;
      tiles(column, row) = static_cast<int>(nodes.size());
      nodes.push_back(node);
    }
  levels_.push_back(std::move(nodes));
  return tiles;
}

std::vector<float> NearestPoints::distances(const std::vector<Eigen::Vector3f>& queries,
                                            const ShareSink& progress) const {
  std::vector<float> found(queries.size(), std::numeric_limits<float>::quiet_NaN());
  share_out(queries.size(), packets_at_once * Packet::size, progress,
            [&](std::size_t first, std::size_t last) {
              for (std::size_t i = first; i < last; i += Packet::size)
                search(&queries[i], std::min<std::size_t>(Packet::size, last - i), &found[i]);
            });
  return found;
}

/// At most a packet of queries.
void NearestPoints::search(const Eigen::Vector3f* queries, std::size_t count, float* distances) const {
  const auto* first =
      std::find_if(queries, queries + count, [](const auto& query) { return query.allFinite(); });
  if (first == queries + count) return;
  Packet packet;
  for (int i = 0; i < Packet::size; ++i) {
    const bool is_query = static_cast<std::size_t>(i) < count && queries[i].allFinite();
    const Eigen::Vector3f& query = is_query ? queries[i] : *first;
    for (int axis = 0; axis < 3; ++axis) packet.query[axis][i] = query[axis];
  }
  begin(packet);
  descend(levels_.size() - 1, 0, packet);
  for (std::size_t i = 0; i < count; ++i)
    if (queries[i].allFinite()) distances[i] = std::sqrt(packet.best[static_cast<int>(i)]);
}

/// The first guess: the point at the pixel that a query projects to, or the last that was guessed before it.
void NearestPoints::begin(Packet& packet) const {
  Eigen::Vector3f guess = Eigen::Vector3f::Constant(infinity);
  for (int i = 0; i < Packet::size; ++i) {
    const Eigen::Vector3f query = packet.at(i);
    const auto u = static_cast<float>(camera_.fx) * query.x() / query.z() + static_cast<float>(camera_.cx);
    const auto v = static_cast<float>(camera_.fy) * query.y() / query.z() + static_cast<float>(camera_.cy);
    if (u >= 0 && v >= 0 && u < static_cast<float>(map_.width()) && v < static_cast<float>(map_.height()))
      if (const auto& point = map_(static_cast<int>(u), static_cast<int>(v)); is_point(point)) guess = point;
    const Eigen::Vector3f away = query - guess;
    packet.best[i] = squared_length(away.x(), away.y(), away.z());
  }
  for (int axis = 0; axis < 3; ++axis) {
    packet.box.lowest[axis] = packet.query[axis].minCoeff();
    packet.box.highest[axis] = packet.query[axis].maxCoeff();
  }
  packet.worst = packet.best.maxCoeff();
}

/// Nearer children first: what they find may rule out the others.
void NearestPoints::descend(std::size_t level, int node, Packet& packet) const {
  const Node& here = levels_[level][static_cast<std::size_t>(node)];
  if (level == 0) {
    visit(here, packet);
    return;
  }
  Row bounds = squared_distances(here.lowest, here.highest, packet.box.lowest, packet.box.highest);
  while (true) {
    int nearest = 0;
    if (!(bounds.minCoeff(&nearest) < packet.worst)) return;
    descend(level - 1, here.child[nearest], packet);
    bounds[nearest] = infinity;
  }
}

/// Looks at the leaves of a node for each query that may find something there.
void NearestPoints::visit(const Node& node, Packet& packet) const {
  using Values = Packet::Values;
  std::array<Values, 3> lowest;
  std::array<Values, 3> highest;
  for (int axis = 0; axis < 3; ++axis) {
    lowest[axis] = packet.query[axis] - node.highest[axis].maxCoeff();
    highest[axis] = node.lowest[axis].minCoeff() - packet.query[axis];
    lowest[axis] = lowest[axis].max(highest[axis]).max(0.0F);
  }
  const Values bounds = squared_length(lowest[0], lowest[1], lowest[2]);
  for (int i = 0; i < Packet::size; ++i) {
    float& best = packet.best[i];
    if (!(bounds[i] < best)) continue;
    const Eigen::Vector3f query = packet.at(i);
    const Row to_leaves = squared_distances(node.lowest, node.highest, query, query);
    for (int k = 0; k < fan; ++k) {
      if (!(to_leaves[k] < best)) continue;
      const Leaf& leaf = leaves_[static_cast<std::size_t>(node.child[k])];
      const Row x = leaf[0] - query.x();
      const Row y = leaf[1] - query.y();
      const Row z = leaf[2] - query.z();
      best = std::min(best, squared_length(x, y, z).minCoeff());
    }
  }
  packet.worst = packet.best.maxCoeff();
}

}  // namespace pliant
