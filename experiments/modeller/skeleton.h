#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/geometry/mesh.h"

namespace pliant {

/// A part of a figure that its joint carries: what is within `radius` mm of a line.
struct Bone {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
  double radius;
};

/// Joints in the order in which they are added, all at rest in the figure's frame.
class Skeleton {
 public:
  /// A joint at `bone.from`, its y axis along the bone, its x axis as near to `x_axis` as can be: a bone that
  /// bends like a finger turns about x. No parent: "".
  Skeleton& add(const std::string& joint, const std::string& parent, const Bone& bone,
                const Eigen::Vector3d& x_axis = Eigen::Vector3d::UnitX());
  /// One more bone of the joint that was added last.
  Skeleton& also(const Bone& bone);

  /// Gives the mesh these joints, and every vertex those of the bones near it: all of the nearest bone, and
  /// of another the less the farther it is than the nearest, none from `blend` mm on; the four with the most.
  void bind(Mesh& mesh, double blend) const;

 private:
  struct Part {
    Joint joint;
    std::vector<Bone> bones;
  };
  JointWeights weights_at(const Eigen::Vector3d& point, double blend) const;

  std::vector<Part> parts_;
};

}  // namespace pliant
