#include "framework/geometry/marching_cubes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

namespace pliant {
namespace {

// Corner c of a cell is at (bit 0, bit 1, bit 2) of c. Edge 4 a + n runs along axis a from the n-th corner
// whose bit a is 0. A case is the set of corners inside, as bits.
constexpr int corners = 8;
constexpr int edges = 12;

using Loop = std::vector<int>;  // edges of a cell that a closed line on its faces crosses

/// The first of the two corners of an edge.
int start_of(int edge) {
  const int axis = edge / 4;
  const int below = (edge % 4) & ((1 << axis) - 1);
  return ((edge % 4 - below) << 1) | below;
}

int edge_between(int corner, int other) {
  for (int edge = 0; edge < edges; ++edge) {
    const int start = start_of(edge);
    const int end = start | (1 << (edge / 4));
    if ((start == corner && end == other) || (start == other && end == corner)) return edge;
  }
  throw std::logic_error("the corners are no neighbours");
}

/// The corners of a face (across `axis`, at its end or not), counter-clockwise seen from outside the cell.
std::array<int, 4> face_corners(int axis, bool at_end) {
  const int u = 1 << (axis + 1) % 3;
  const int v = 1 << (axis + 2) % 3;
  const int base = at_end ? 1 << axis : 0;
  return at_end ? std::array{base, base | u, base | u | v, base | v}
                : std::array{base, base | v, base | u | v, base | u};
}

bool share_a_face(int edge, int other) {
  const auto lies_on = [](int e, int axis, int side) {
    return e / 4 != axis && ((start_of(e) >> axis) & 1) == side;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      if (lies_on(edge, axis, side) && lies_on(other, axis, side)) return true;
    }
  }
  return false;
}

/// For each crossed edge the one where the surface's line on a face goes on. On a face each run of corners
/// inside has a line of its own, from the edge where it begins to the one where it ends.
std::array<int, edges> lines_on_faces(int inside) {
  std::array<int, edges> next;
  next.fill(-1);
  for (int face = 0; face < 6; ++face) {
    const auto ring = face_corners(face / 2, face % 2 == 1);
    const auto is_inside = [&](int n) {
      return ((inside >> ring[static_cast<std::size_t>(n % 4)]) & 1) == 1;
    };
    const auto edge_after = [&](int n) {
      return edge_between(ring[static_cast<std::size_t>(n % 4)], ring[static_cast<std::size_t>((n + 1) % 4)]);
    };
    for (int n = 0; n < 4; ++n) {
      if (is_inside(n) || !is_inside(n + 1)) continue;
      int last = n + 1;
      while (is_inside(last + 1)) ++last;
      next[static_cast<std::size_t>(edge_after(n))] = edge_after(last);
    }
  }
  return next;
}

/// Cuts a loop into triangles none of whose inner edges lies on a face of the cell: the neighbour could have
/// the same edge there. Whether that is possible.
bool triangulate(const Loop& loop, std::vector<Eigen::Vector3i>& triangles) {
  const std::size_t n = loop.size();
  if (n == 3) {
    triangles.emplace_back(loop[0], loop[1], loop[2]);
    return true;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const int before = loop[(i + n - 1) % n];
    const int after = loop[(i + 1) % n];
    if (share_a_face(before, after)) continue;
    const std::size_t known = triangles.size();
    triangles.emplace_back(before, loop[i], after);
    Loop rest = loop;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (triangulate(rest, triangles)) return true;
    triangles.resize(known);
  }
  return false;
}

/// Triangles between crossed edges.
std::vector<Eigen::Vector3i> triangles_of_case(int inside) {
  std::array<int, edges> next = lines_on_faces(inside);
  std::vector<Eigen::Vector3i> triangles;
  for (int first = 0; first < edges; ++first) {
    Loop loop;
    for (int edge = first; next[static_cast<std::size_t>(edge)] >= 0;) {
      loop.push_back(edge);
      edge = std::exchange(next[static_cast<std::size_t>(edge)], -1);
    }
    if (!loop.empty() && !triangulate(loop, triangles))
      throw std::logic_error("a case of marching cubes cannot be cut into triangles");
  }
  return triangles;
}

using Cases = std::array<std::vector<Eigen::Vector3i>, 1 << corners>;

const Cases& cases() {
  static const Cases all = [] {
    Cases made;
    for (std::size_t inside = 0; inside < made.size(); ++inside)
      made[inside] = triangles_of_case(static_cast<int>(inside));
    return made;
  }();
  return all;
}

class Marcher {
 public:
  Marcher(const SampleGrid& grid, const DistanceLayers& layers)
      : grid_(grid),
        layers_(layers),
        nx_(grid.size.x()),
        ny_(grid.size.y()),
        values_(2 * layer_size()),
        edge_vertex_(6 * layer_size(), -1) {}

  Mesh march() {
    take_layer(0);
    for (int k = 0; k + 1 < grid_.size.z(); ++k) {
      take_layer(k + 1);
      for (int j = 0; j + 1 < ny_; ++j) {
        for (int i = 0; i + 1 < nx_; ++i) march_cell({i, j, k});
      }
    }
    return std::move(mesh_);
  }

 private:
  std::size_t layer_size() const { return static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_); }
  /// Of a sample among those of two layers.
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) + static_cast<std::size_t>(nx_) * static_cast<std::size_t>(j) +
           layer_size() * static_cast<std::size_t>(k % 2);
  }

  /// Takes a layer of samples in the place of the last but one, and forgets the vertices of its edges.
  void take_layer(int k) {
    layers_(k, std::span(values_).subspan(index(0, 0, k), layer_size()));
    const auto begin = edge_vertex_.begin() + static_cast<std::ptrdiff_t>(3 * index(0, 0, k));
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(3 * layer_size()), -1);
  }

  void march_cell(const Eigen::Vector3i& cell) {
    const std::size_t near = index(cell.x(), cell.y(), cell.z());
    const std::size_t far = index(cell.x(), cell.y(), cell.z() + 1);
    const auto row = static_cast<std::size_t>(nx_);
    const std::array<float, corners> values{
        values_[near], values_[near + 1], values_[near + row], values_[near + row + 1],
        values_[far],  values_[far + 1],  values_[far + row],  values_[far + row + 1]};
    int inside = 0;
    for (std::size_t c = 0; c < corners; ++c) inside |= static_cast<int>(values[c] < 0) << c;
    const auto& triangles = cases()[static_cast<std::size_t>(inside)];
    if (triangles.empty()) return;
    for (const float value : values) {
      if (!std::isfinite(value)) return;
    }
    for (const Eigen::Vector3i& triangle : triangles) {
      mesh_.triangles.emplace_back(vertex(cell, triangle[0]), vertex(cell, triangle[1]),
                                   vertex(cell, triangle[2]));
    }
  }

  int vertex(const Eigen::Vector3i& cell, int edge) {
    const int corner = start_of(edge);
    const int axis = edge / 4;
    const Eigen::Vector3i start = cell + Eigen::Vector3i(corner & 1, (corner >> 1) & 1, corner >> 2);
    int& known = edge_vertex_[3 * index(start.x(), start.y(), start.z()) + static_cast<std::size_t>(axis)];
    if (known < 0) {
      known = static_cast<int>(mesh_.vertices.size());
      mesh_.vertices.push_back(crossing(start, axis));
    }
    return known;
  }

  /// Where the distance is 0 between a sample and the next along an axis. Never at a sample itself, where
  /// several edges would meet and triangles vanish.
  Eigen::Vector3f crossing(const Eigen::Vector3i& start, int axis) const {
    constexpr double margin = 0.01;
    const Eigen::Vector3i end = start + Eigen::Vector3i::Unit(axis);
    const double from = values_[index(start.x(), start.y(), start.z())];
    const double to = values_[index(end.x(), end.y(), end.z())];
    Eigen::Vector3d place = start.cast<double>();
    place[axis] += std::clamp(from / (from - to), margin, 1 - margin);
    return (grid_.origin + grid_.spacing * place).cast<float>();
  }

  const SampleGrid& grid_;
  const DistanceLayers& layers_;
  int nx_;
  int ny_;
  std::vector<float> values_;     // of two layers
  std::vector<int> edge_vertex_;  // of the three edges that start at each sample of two layers; -1: none yet
  Mesh mesh_;
};

}  // namespace

Mesh marching_cubes(const DistanceGrid& grid) {
  const Eigen::Matrix<std::size_t, 3, 1> size = grid.size.cwiseMax(0).cast<std::size_t>();
  if (grid.values.size() != size.prod()) throw std::invalid_argument("a grid takes one distance per sample");
  if (grid.values.empty()) return {};
  const auto layer_size = size.x() * size.y();
  return marching_cubes(grid, [&](int k, std::span<float> values) {
    std::copy_n(grid.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * layer_size),
                layer_size, values.begin());
  });
}

Mesh marching_cubes(const SampleGrid& grid, const DistanceLayers& layers) {
  if (grid.size.minCoeff() < 1) return {};
  return Marcher(grid, layers).march();
}

}  // namespace pliant
