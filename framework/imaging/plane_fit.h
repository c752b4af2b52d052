#pragma once

#include "framework/imaging/normals.h"

namespace pliant {

/// The plane fitted to the points of a window whose depth is near that of its centre; what make_surface_image
/// of surface.h does, which is its reference. Where depth is sparse the window grows.
class PlaneFit : public Normals {
 public:
  /// `radius` (pixels) of the window, at most max_window_radius; `depth_step` in mm.
  explicit PlaneFit(int radius = default_normal_radius, float depth_step = default_depth_step);

  void write(Device& device, const DepthMap& map, SurfaceMap& surface) const override;

 private:
  int radius_;
  float depth_step_;
};

}  // namespace pliant
