#pragma once

#include <vector>

#include "framework/imaging/depth_filter.h"

namespace pliant {

/// The bilateral filter [Eq. 3.1]: each depth becomes the mean of the depths in the window around it, with
/// weights that fall with the distance in the image and with the difference in depth, so that noise is
/// averaged and steps stay. Pixels without depth take no part.
class BilateralFilter : public DepthFilter {
 public:
  /// `sigma_space` in pixels, `sigma_depth` in mm; `radius` (pixels) of the window, at most
  /// max_window_radius.
  BilateralFilter(double sigma_space, double sigma_depth, int radius);

  std::optional<DepthMap> filter(Device& device, const DepthMap& map, const Camera& camera) const override;

  /// Plain C++ reference of `filter`, 0 where there is no depth.
  DepthImage filter_reference(const DepthImage& depth) const;

 private:
  double sigma_space_;
  double sigma_depth_;
  int radius_;
  Array<float> space_;  ///< the spatial weights, which go to the device once
};

/// How uncertain the depths of a map are: the standard deviation (mm) of white noise whose second differences
/// along the rows would have the same median magnitude. Steps of depth hardly count, nor does a surface that
/// bends little from pixel to pixel. Of depths in steps so coarse that most neighbours are equal, that of the
/// rounding. 0 where no three pixels in a row have depth.
double estimate_noise(const DepthMap& map);

/// The bilateral filter [Eq. 3.1] with a window as wide as the noise asks for, so that normals are equally
/// certain whatever the camera. White noise of standard deviation s (mm) tilts the normals of points that lie
/// d mm apart (median depth / focal length) by about s / d; a Gaussian window of sigma_d pixels takes that
/// down by 1 / sigma_d^2: sigma_d = gain * sqrt(s / d). Where there is hardly any noise, depth stays as it
/// is: what is smoothed without need loses its shape.
class BilateralByNoise : public DepthFilter {
 public:
  /// `gain`: sigma_d in pixels where s = d.
  BilateralByNoise(double gain, double sigma_depth);

  std::optional<DepthMap> filter(Device& device, const DepthMap& map, const Camera& camera) const override;

  /// sigma_d in pixels for a map.
  double sigma_space(const DepthMap& map, const Camera& camera) const;

 private:
  double gain_;
  double sigma_depth_;
};

}  // namespace pliant
