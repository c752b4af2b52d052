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
  /// bends like a finger turns about x. No parent: "". `blend`: how many mm farther from a vertex than the
  /// nearest joint's bones this one's may be and still carry a little of it.
  Skeleton& add(const std::string& joint, const std::string& parent, const Bone& bone, double blend,
                const Eigen::Vector3d& x_axis = Eigen::Vector3d::UnitX());
  /// One more bone of the joint that was added last.
  Skeleton& also(const Bone& bone);

  /// Gives the mesh these joints, and every vertex those of the bones near it: the nearest, and another the
  /// less the farther it is than the nearest, not at all from its `blend` on; of these the four with the
  /// most.
  void bind(Mesh& mesh) const;

 private:
  struct Part {
    Joint joint;
    std::vector<Bone> bones;
    double blend;
  };
  JointWeights weights_at(const Eigen::Vector3d& point) const;

  std::vector<Part> parts_;
};

}  // namespace pliant
