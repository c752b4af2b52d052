#pragma once

#include "framework/geometry/pixel_index.h"

namespace pliant {

/// A surface as graph builders and samplers see it.
class ViewedSurface {
 public:
  explicit ViewedSurface(const Surface& surface)
      : pixels_(index_pixels(surface)), points_{flatten(surface.points), flatten(surface.normals)} {}

  operator SurfaceView() const { return {pixels_, points_, camera_}; }  // NOLINT(google-explicit-constructor)

 private:
  PixelIndex pixels_;
  PointSet points_;
  Camera camera_;
};

}  // namespace pliant
