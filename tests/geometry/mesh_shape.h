#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "framework/geometry/mesh.h"

namespace pliant::test {

/// What counting tells of a list of triangles.
struct MeshShape {
  int open_edges = 0;      ///< that one triangle has and none has in the opposite direction
  int repeated_edges = 0;  ///< that two triangles have in the same direction
  int unused_vertices = 0;
  int euler = 0;            ///< vertices - edges + triangles: 2 - 2 * handles for one closed surface
  double volume = 0;        ///< mm^3, negative where the inside is out
  double least_height = 0;  ///< mm, of the flattest triangle over its longest side
};

inline MeshShape shape_of(const Mesh& mesh) {
  MeshShape shape;
  std::vector<std::pair<int, int>> edges;  // of each triangle, in its direction
  std::vector<bool> used(mesh.vertices.size(), false);
  shape.least_height = std::numeric_limits<double>::max();
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) {
      edges.emplace_back(triangle[k], triangle[(k + 1) % 3]);
      used.at(static_cast<std::size_t>(triangle[k])) = true;
      corners.col(k) = mesh.vertices.at(static_cast<std::size_t>(triangle[k])).cast<double>();
    }
    shape.volume += corners.determinant() / 6;
    const Eigen::Vector3d a = corners.col(1) - corners.col(0);
    const Eigen::Vector3d b = corners.col(2) - corners.col(0);
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    shape.least_height = std::min(shape.least_height, a.cross(b).norm() / std::max(longest, 1e-30));
  }
  std::sort(edges.begin(), edges.end());
  int count = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::pair<int, int> opposite(edges[i].second, edges[i].first);
    const bool has_opposite = std::binary_search(edges.begin(), edges.end(), opposite);
    shape.repeated_edges += i > 0 && edges[i] == edges[i - 1] ? 1 : 0;
    shape.open_edges += has_opposite ? 0 : 1;
    count += !has_opposite || edges[i] < opposite ? 1 : 0;
  }
  shape.unused_vertices = static_cast<int>(std::count(used.begin(), used.end(), false));
  shape.euler = static_cast<int>(mesh.vertices.size()) - count + static_cast<int>(mesh.triangles.size());
  return shape;
}

}  // namespace pliant::test
