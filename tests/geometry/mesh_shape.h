#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "framework/geometry/mesh.h"

namespace pliant::testing {

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
  std::map<std::pair<int, int>, int> edges;
  std::vector<bool> used(mesh.vertices.size(), false);
  shape.least_height = std::numeric_limits<double>::max();
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) {
      ++edges[{triangle[k], triangle[(k + 1) % 3]}];
      used.at(static_cast<std::size_t>(triangle[k])) = true;
      corners.col(k) = mesh.vertices.at(static_cast<std::size_t>(triangle[k])).cast<double>();
    }
    shape.volume += corners.determinant() / 6;
    const Eigen::Vector3d a = corners.col(1) - corners.col(0);
    const Eigen::Vector3d b = corners.col(2) - corners.col(0);
    const double longest = std::max({a.norm(), b.norm(), (a - b).norm()});
    shape.least_height = std::min(shape.least_height, a.cross(b).norm() / std::max(longest, 1e-30));
  }
  int count = 0;
  for (const auto& [edge, times] : edges) {
    const bool has_opposite = edges.count({edge.second, edge.first}) > 0;
    shape.repeated_edges += times > 1 ? 1 : 0;
    shape.open_edges += has_opposite ? 0 : 1;
    count += !has_opposite || edge.first < edge.second ? 1 : 0;
  }
  shape.unused_vertices = static_cast<int>(std::count(used.begin(), used.end(), false));
  shape.euler = static_cast<int>(mesh.vertices.size()) - count + static_cast<int>(mesh.triangles.size());
  return shape;
}

}  // namespace pliant::testing
