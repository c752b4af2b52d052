#include "tests/modeller/figures.h"

#include <algorithm>
#include <stdexcept>

#include "experiments/modeller/pose.h"

namespace pliant::test {

const FigureKind& kind_of(const std::string& name) {
  const auto& kinds = figure_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const FigureKind& kind) { return kind.name == name; });
  if (found == kinds.end()) throw std::logic_error("no figure " + name);
  return *found;
}

Figure made(const std::string& name, const std::map<std::string, double>& identity) {
  const FigureKind& kind = kind_of(name);
  std::vector<Parameters::Value> values;
  for (const Parameter& row : kind.identity.rows()) {
    const auto given = identity.find(row.name());
    values.push_back(
        {row.name(), given == identity.end() ? std::stod(row.default_text().value()) : given->second});
  }
  return kind.make(Parameters("", values));
}

std::vector<Eigen::Vector3d> posed(const Figure& figure, const std::string& pose, double share) {
  const auto found = std::find_if(figure.poses.begin(), figure.poses.end(),
                                  [&](const NamedPose& known) { return known.name == pose; });
  if (found == figure.poses.end()) throw std::logic_error("no pose " + pose);
  return posed(figure.mesh, *found, share);
}

std::vector<Eigen::Vector3d> posed(const Mesh& mesh, const NamedPose& pose, double share) {
  FigurePose form = rest_of(mesh);
  add_pose(mesh, pose, share, form);
  return mesh.deform(on_top(mesh.rest(), form));
}

std::size_t vertex_near(const Figure& figure, const Eigen::Vector3d& point) {
  const auto& vertices = figure.mesh.vertices;
  const auto nearer = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return (a.cast<double>() - point).squaredNorm() < (b.cast<double>() - point).squaredNorm();
  };
  return static_cast<std::size_t>(std::min_element(vertices.begin(), vertices.end(), nearer) -
                                  vertices.begin());
}

}  // namespace pliant::test
