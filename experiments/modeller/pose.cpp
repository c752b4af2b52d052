#include "experiments/modeller/pose.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "framework/core/angle.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

/// Where the list has what a pose names.
template <class Named>
std::size_t index_of(const std::vector<Named>& list, const std::string& name, const NamedPose& pose) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) return i;
    names.push_back(list[i].name);
  }
  throw std::invalid_argument("the pose " + pose.name + " moves " + name + ", which the mesh does not have" +
                              suggestion(name, names));
}

}  // namespace

FigurePose rest_of(const Mesh& mesh) {
  return {std::vector<double>(mesh.targets.size(), 0),
          std::vector<Eigen::Vector3d>(mesh.joints.size(), Eigen::Vector3d::Zero())};
}

void add_pose(const Mesh& mesh, const NamedPose& named, double share, FigurePose& pose) {
  for (const auto& [target, weight] : named.weights)
    pose.weights[index_of(mesh.targets, target, named)] += share * weight;
  for (const NamedPose::Turn& turn : named.turns)
    pose.degrees[index_of(mesh.joints, turn.joint, named)] += share * turn.degrees;
}

MeshPose on_top(MeshPose beneath, const FigurePose& pose) {
  for (std::size_t i = 0; i < pose.weights.size(); ++i) beneath.weights[i] += pose.weights[i];
  for (std::size_t i = 0; i < pose.degrees.size(); ++i) {
    const Eigen::Vector3d radians = degree * pose.degrees[i];
    beneath.joints[i] = beneath.joints[i] * Eigen::AngleAxisd(radians.z(), Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(radians.y(), Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(radians.x(), Eigen::Vector3d::UnitX());
  }
  return beneath;
}

}  // namespace pliant
