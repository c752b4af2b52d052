#pragma once

#include <vector>

#include "framework/geometry/depth_filter.h"

namespace pliant {

/// The bilateral filter [Eq. 3.1]: each depth becomes the mean of the depths in the window around it, with
/// weights that fall with the distance in the image and with the difference in depth, so that noise is
/// averaged and steps stay. Pixels without depth take no part.
class BilateralFilter : public DepthFilter {
 public:
  /// `sigma_space` in pixels, `sigma_depth` in mm; `radius` (pixels) of the window, at most
  /// max_window_radius.
  BilateralFilter(double sigma_space, double sigma_depth, int radius);

  std::optional<DepthMap> filter(Device& device, const DepthMap& map) const override;

  /// Plain C++ reference of `filter`, 0 where there is no depth.
  DepthImage filter_reference(const DepthImage& depth) const;

 private:
  double sigma_space_;
  double sigma_depth_;
  int radius_;
};

}  // namespace pliant
