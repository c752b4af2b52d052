#include "framework/evaluation/mesh_distance.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pliant {
namespace {

constexpr int looked_at = 8;  // samples a query, so that the triangles around an edge are all measured

using Corners = std::array<Eigen::Vector3f, 3>;

Corners corners_of(const Mesh& mesh, const Eigen::Vector3i& triangle) {
  const auto corner = [&](int i) { return mesh.vertices[static_cast<std::size_t>(triangle[i])]; };
  return {corner(0), corner(1), corner(2)};
}

Eigen::Vector3f nearest_in_segment(const Eigen::Vector3f& point, const Eigen::Vector3f& a,
                                   const Eigen::Vector3f& b) {
  const Eigen::Vector3f way = b - a;
  const float length = way.squaredNorm();
  return a + (length > 0 ? std::clamp((point - a).dot(way) / length, 0.0F, 1.0F) : 0.0F) * way;
}

}  // namespace

Eigen::Vector3f nearest_in_triangle(const Eigen::Vector3f& point, const Eigen::Vector3f& a,
                                    const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  const float area = normal.squaredNorm();
  const auto share = [&](const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
    return (to - from).cross(point - from).dot(normal);
  };
  if (area > 0 && share(a, b) >= 0 && share(b, c) >= 0 && share(c, a) >= 0)
    return point - (point - a).dot(normal) / area * normal;
  const Corners ends{nearest_in_segment(point, a, b), nearest_in_segment(point, b, c),
                     nearest_in_segment(point, c, a)};
  return *std::min_element(ends.begin(), ends.end(), [&](const auto& one, const auto& other) {
    return (one - point).squaredNorm() < (other - point).squaredNorm();
  });
}

struct MeshDistance::Samples {
  const Mesh& mesh;
  std::vector<float> points = {};   // x y z in turn
  std::vector<int> triangles = {};  // of each
  std::unique_ptr<flann::KDTreeSingleIndex<flann::L2_3D<float>>> tree = {};

  void add(int triangle, double spacing) {
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[static_cast<std::size_t>(triangle)]);
    const float longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        const float u = (static_cast<float>(i) + 1.0F / 3) / static_cast<float>(steps);
        const float v = (static_cast<float>(j) + 1.0F / 3) / static_cast<float>(steps);
        const Eigen::Vector3f sample = a + u * (b - a) + v * (c - a);
        points.insert(points.end(), sample.data(), sample.data() + 3);
        triangles.push_back(triangle);
      }
  }

  float distance(const Eigen::Vector3f& point) const {
    Eigen::Vector3f query = point;
    const auto count = std::min<std::size_t>(looked_at, triangles.size());
    std::array<int, looked_at> indices{};
    std::array<float, looked_at> squares{};
    const flann::Matrix<float> queries(query.data(), 1, 3);
    flann::Matrix<int> found(indices.data(), 1, count);
    flann::Matrix<float> distances(squares.data(), 1, count);
    tree->knnSearch(queries, found, distances, count, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      const auto triangle = static_cast<std::size_t>(triangles[static_cast<std::size_t>(indices[i])]);
      const auto [a, b, c] = corners_of(mesh, mesh.triangles[triangle]);
      least = std::min(least, (nearest_in_triangle(point, a, b, c) - point).norm());
    }
    return least;
  }
};

MeshDistance::MeshDistance(const Mesh& mesh, double spacing) : samples_(new Samples{mesh}) {
  if (mesh.triangles.empty()) throw std::invalid_argument("a mesh without triangles has no surface");
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) samples_->add(i, spacing);
  const flann::Matrix<float> points(samples_->points.data(), samples_->triangles.size(), 3);
  samples_->tree = std::make_unique<flann::KDTreeSingleIndex<flann::L2_3D<float>>>(points);
  samples_->tree->buildIndex();
}

MeshDistance::~MeshDistance() = default;

std::vector<float> MeshDistance::distances(const std::vector<Eigen::Vector3f>& points) const {
  std::vector<float> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector3f& point : points) distances.push_back(samples_->distance(point));
  return distances;
}

}  // namespace pliant
