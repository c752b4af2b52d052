#pragma once

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// The surface to be reached, as images that live on the device: x y z per pixel, (0, 0, 0) where there is
/// no point. A point or normal that is not finite counts as none.
struct Target {
  Camera camera;
  Array<float> points;   ///< mm, camera frame
  Array<float> normals;  ///< unit length, or (0, 0, 0)

  /// `map`: one point a pixel of the camera.
  Target(const Camera& camera, PointSet map);
  Target(const Camera& camera, const SurfaceMap& map);
};

}  // namespace pliant
