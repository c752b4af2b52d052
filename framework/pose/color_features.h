#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/frame.h"

namespace pliant {

/// Features of a colour image that have depth.
struct ColorFeatures {
  std::vector<float> descriptors;       ///< 128 numbers of each
  std::vector<Eigen::Vector3d> points;  ///< mm, camera frame
  std::vector<double> radii;            ///< mm on the surface
};

/// Features [SIFT, Lowe 2004] of a frame that has colour at the depth's pixels, where it has depth inside its
/// mask. The image is shrunk by `scale` first. Depth is that of a plane through 5 x 5 pixels.
ColorFeatures find_color_features(const Frame& frame, const Camera& camera, double scale);

/// What the image is to be shrunk by: `least`, but no further than that `fewest_pixels` of the object are
/// left, at most not at all.
double scale_of_features(const Frame& frame, double least, double fewest_pixels);

}  // namespace pliant
