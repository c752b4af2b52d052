#include "tests/modeller/intersections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace pliant::test {
namespace {

using Cell = std::tuple<int, int, int>;

class IntersectionTest {
 public:
  explicit IntersectionTest(const Mesh& mesh) : mesh_(mesh) {}

  std::size_t count() const {
    std::set<std::pair<std::size_t, std::size_t>> found;
    for (const auto& [cell, triangles] : cells()) {
      for (std::size_t a = 0; a < triangles.size(); ++a) {
        for (std::size_t b = a + 1; b < triangles.size(); ++b) {
          const std::size_t first = triangles[a];
          const std::size_t second = triangles[b];
          if (boxes_[first].intersects(boxes_[second]) && (pierces(first, second) || pierces(second, first)))
            found.emplace(first, second);
        }
      }
    }
    return found.size();
  }

 private:
  Eigen::Vector3d corner(std::size_t triangle, int k) const {
    return mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[triangle][k])].cast<double>();
  }

  /// The triangles whose boxes reach into each cell of a grid.
  std::map<Cell, std::vector<std::size_t>> cells() const {
    double length = 0;  // of the mean triangle
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      Eigen::AlignedBox3d box;
      for (int k = 0; k < 3; ++k) box.extend(corner(t, k));
      length += box.sizes().maxCoeff() / static_cast<double>(mesh_.triangles.size());
      boxes_.push_back(box);
    }
    std::map<Cell, std::vector<std::size_t>> cells;
    for (std::size_t t = 0; t < boxes_.size(); ++t) {
      const Eigen::Vector3i low = (boxes_[t].min() / length).array().floor().cast<int>();
      const Eigen::Vector3i high = (boxes_[t].max() / length).array().floor().cast<int>();
      for (int k = low.z(); k <= high.z(); ++k) {
        for (int j = low.y(); j <= high.y(); ++j) {
          for (int i = low.x(); i <= high.x(); ++i) cells[{i, j, k}].push_back(t);
        }
      }
    }
    return cells;
  }

  bool has_corner(std::size_t triangle, int vertex) const {
    return (mesh_.triangles[triangle].array() == vertex).any();
  }

  /// Whether an edge of the first passes through the inside of the second.
  bool pierces(std::size_t first, std::size_t second) const {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3i& triangle = mesh_.triangles[first];
      if (has_corner(second, triangle[k]) || has_corner(second, triangle[(k + 1) % 3])) continue;
      if (passes_through(corner(first, k), corner(first, (k + 1) % 3), second)) return true;
    }
    return false;
  }

  /// Whether the five volumes that the points span say that the segment meets the triangle.
  bool passes_through(const Eigen::Vector3d& from, const Eigen::Vector3d& to, std::size_t triangle) const {
    const Eigen::Vector3d a = corner(triangle, 0);
    const Eigen::Vector3d b = corner(triangle, 1);
    const Eigen::Vector3d c = corner(triangle, 2);
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if ((from - a).dot(normal) * (to - a).dot(normal) >= 0) return false;
    const auto side = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
      return (p - from).cross(q - from).dot(to - from);
    };
    const double u = side(a, b);
    const double v = side(b, c);
    const double w = side(c, a);
    return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
  }

  const Mesh& mesh_;
  mutable std::vector<Eigen::AlignedBox3d> boxes_;
};

}  // namespace

std::size_t count_intersections(const Mesh& mesh) { return IntersectionTest(mesh).count(); }

}  // namespace pliant::test
