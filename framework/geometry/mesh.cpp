#include "framework/geometry/mesh.h"

#include <cstddef>
#include <stdexcept>

namespace pliant {

std::vector<std::string> Mesh::target_names() const {
  std::vector<std::string> names;
  for (const MorphTarget& target : targets) names.push_back(target.name);
  return names;
}

std::vector<Eigen::Vector3d> Mesh::deform(const std::vector<double>& weights) const {
  if (weights.size() != targets.size()) throw std::invalid_argument("a mesh takes one weight per target");
  std::vector<Eigen::Vector3d> deformed;
  deformed.reserve(vertices.size());
  for (const Eigen::Vector3f& vertex : vertices) deformed.push_back(vertex.cast<double>());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const auto& displacements = targets[t].displacements;
    if (displacements.size() != vertices.size()) {
      throw std::invalid_argument("a morph target takes one displacement per vertex");
    }
    if (weights[t] == 0) continue;
    for (std::size_t i = 0; i < deformed.size(); ++i)
      deformed[i] += weights[t] * displacements[i].cast<double>();
  }
  return deformed;
}

}  // namespace pliant
