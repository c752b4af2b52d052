#pragma once

#include "framework/imaging/normals.h"

namespace pliant {

/// The cross product of the differences between the points on either side of a pixel, along its row and along
/// its column: the fastest, and the one that noise moves most. A neighbour without depth, or that lies
/// further away in depth than `depth_change` allows, is replaced by the pixel itself.
class CrossProduct : public Normals {
 public:
  /// `reach`: pixels to the neighbours, at most max_window_radius; `depth_change`: part of the depth by which
  /// it may change from a pixel to the next on one surface.
  CrossProduct(int reach, double depth_change);

  void write(Device& device, const DepthMap& map, SurfaceMap& surface) const override;
  /// Plain C++ reference of `write`: the normals, (0, 0, 0) where there is none.
  Image<Eigen::Vector3f> reference(const DepthImage& depth, const Camera& camera) const;

 private:
  int reach_;
  float depth_change_;
};

}  // namespace pliant
