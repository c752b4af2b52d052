#include "experiments/view/clustered_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace pliant {
namespace {

/// Which cube of a grid each vertex is in, numbered as they come.
struct Clusters {
  std::vector<int> of_vertices;
  std::size_t count = 0;
};

Clusters clusters_of(const std::vector<Eigen::Vector3f>& vertices, const Eigen::Vector3f& corner,
                     float side) {
  std::unordered_map<std::uint64_t, int> numbers;
  Clusters clusters;
  clusters.of_vertices.reserve(vertices.size());
  for (const Eigen::Vector3f& vertex : vertices) {
    std::uint64_t cube = 0;
    for (const float place : (vertex - corner) / side)
      cube = cube << 21 | static_cast<std::uint64_t>(place);  // fewer than 2^21 a side
    clusters.of_vertices.push_back(numbers.try_emplace(cube, static_cast<int>(numbers.size())).first->second);
  }
  clusters.count = numbers.size();
  return clusters;
}

std::vector<Eigen::Vector3f> means(const std::vector<Eigen::Vector3f>& vertices, const Clusters& clusters) {
  std::vector<Eigen::Vector3f> sums(clusters.count, Eigen::Vector3f::Zero());
  std::vector<float> counts(clusters.count, 0);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto cluster = static_cast<std::size_t>(clusters.of_vertices[i]);
    sums[cluster] += vertices[i];
    ++counts[cluster];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= counts[i];
  return sums;
}

}  // namespace

ViewData::Mesh clustered_mesh(const Mesh& mesh, std::size_t most) {
  if (mesh.vertices.size() <= most) return {mesh.vertices, mesh.triangles};
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  // A plane through the box would have so many cubes; a surface has more.
  float side = box.sizes().maxCoeff() / std::sqrt(static_cast<float>(most));
  Clusters clusters = clusters_of(mesh.vertices, box.min(), side);
  while (clusters.count > most) clusters = clusters_of(mesh.vertices, box.min(), side *= 1.2F);
  ViewData::Mesh small{means(mesh.vertices, clusters), {}};
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const auto corner = [&](int i) { return clusters.of_vertices[static_cast<std::size_t>(triangle[i])]; };
    const Eigen::Vector3i corners(corner(0), corner(1), corner(2));
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      small.triangles.push_back(corners);
  }
  return small;
}

}  // namespace pliant
