#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "framework/geometry/mesh.h"

namespace pliant {

/// How far points are from the surface of a mesh at rest. Triangles are found by the nearest of samples that
/// lie at most `spacing` apart on them, then measured exactly: a distance is never too small, and too great
/// by less than half a spacing where the surface bends sharply and some other triangle is nearer.
class MeshDistance {
 public:
  /// `spacing` in mm. The mesh must outlive this. Throws std::invalid_argument when it has no triangle.
  explicit MeshDistance(const Mesh& mesh, double spacing = 5);
  ~MeshDistance();

  /// mm, one per point, which are in the mesh's frame.
  std::vector<float> distances(const std::vector<Eigen::Vector3f>& points) const;

 private:
  struct Samples;
  std::unique_ptr<Samples> samples_;
};

/// The point of a triangle that is nearest to another one.
Eigen::Vector3f nearest_in_triangle(const Eigen::Vector3f& point, const Eigen::Vector3f& a,
                                    const Eigen::Vector3f& b, const Eigen::Vector3f& c);

}  // namespace pliant
