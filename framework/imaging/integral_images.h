#pragma once

#include "framework/imaging/normals.h"

namespace pliant {

/// The direction of least variance of the points in a window around each pixel, from integral images:
/// constant time whatever the window [Holzer, Rusu, Dixon, Gedikli, Navab 2012, "Adaptive neighborhood
/// selection for real-time surface normal estimation from organized point cloud data using integral images"].
/// As there, windows shrink where they would reach over a hole or a jump of depth, so that edges stay sharp.
///
/// A point p = z ray weighs by 1 / z^2 in the covariance. Its sums are then those of ray ray^T, which are
/// known, and of the inverse depth q = 1 / z: of q, q u, q v and q^2, four integral images instead of nine.
/// They hold q in whole steps, and their differences are exact even where the sums have overflown: no window
/// knows what lies before it.
class IntegralImages : public Normals {
 public:
  static constexpr int max_radius = 8;        ///< pixels: what differences of the sums have room for
  static constexpr float nearest_depth = 64;  ///< mm; nearer points have no normal

  /// `radius` (pixels) of the widest window; `depth_change`: part of the depth by which it may change from a
  /// pixel to the next on one surface.
  IntegralImages(int radius, double depth_change);

  void write(Device& device, const DepthMap& map, SurfaceMap& surface) const override;
  /// Plain C++ reference of `write`, by the covariance of each window's points and its eigenvectors: the
  /// normals, (0, 0, 0) where there is none.
  Image<Eigen::Vector3f> reference(const DepthImage& depth, const Camera& camera) const;

 private:
  int radius_;
  float depth_change_;
};

}  // namespace pliant
