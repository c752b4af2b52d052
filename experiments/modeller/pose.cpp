#include "experiments/modeller/pose.h"

#include <algorithm>
#include <stdexcept>

#include "experiments/modeller/shape.h"

namespace pliant {
namespace {

/// Where the list has the one with that name.
template <class Named>
std::size_t index_of(const std::vector<Named>& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& item) { return item.name == name; });
  if (found == list.end()) throw std::invalid_argument("the mesh of the pose has no " + name);
  return static_cast<std::size_t>(found - list.begin());
}

}  // namespace

MeshPose mesh_pose(const Mesh& mesh, const NamedPose& pose, double share) {
  MeshPose made = mesh.rest();
  for (const auto& [target, weight] : pose.weights)
    made.weights[index_of(mesh.targets, target)] += share * weight;
  for (const NamedPose::Turn& turn : pose.turns) {
    const Eigen::Vector3d degrees = share * turn.degrees;
    made.joints[index_of(mesh.joints, turn.joint)].rotate(turned(degrees.x(), degrees.y(), degrees.z()));
  }
  return made;
}

}  // namespace pliant
