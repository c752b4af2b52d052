#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// What the ray through a pixel's centre meets first.
struct Fragment {
  int triangle = -1;  ///< index into the list of triangles; -1 where the ray meets none
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< of the point met, in the triangle
  double depth = 0;                                       ///< of the point met, along the optical axis, in mm
};

/// Renders triangles by z-buffer: for every pixel the nearest point, at `near` mm or farther, in which the
/// ray through its centre meets a triangle. The point is exact, however the triangle lies to the camera and
/// whatever part of it is behind. Both sides of a triangle are seen, as by a depth camera; of two at the
/// same depth the first in the list is. Every ray through a closed mesh meets it: nothing shows through
/// shared edges. `vertices`: mm in the camera's frame; a triangle with one that is not finite is not drawn.
/// Throws std::invalid_argument when a triangle names a vertex that does not exist.
Image<Fragment> render_mesh(const std::vector<Eigen::Vector3d>& vertices,
                            const std::vector<Eigen::Vector3i>& triangles, const Camera& camera,
                            double near = 1);

/// Depth in mm, 0 where no triangle is seen.
DepthImage depth_of(const Image<Fragment>& seen);

/// A value per vertex, interpolated to the point of a triangle that a pixel shows (`fragment.triangle` >= 0).
Eigen::Vector3d interpolate(const Fragment& fragment, const std::vector<Eigen::Vector3i>& triangles,
                            const std::vector<Eigen::Vector3d>& values);

/// Motion of the material point that each pixel of `seen` shows while the vertices go from `from` to `to`
/// (mm; `seen` is the rendering of `from`); NaN where nothing is seen. Whether the point can still be seen
/// afterwards plays no part.
Image<Eigen::Vector3f> scene_flow(const Image<Fragment>& seen, const std::vector<Eigen::Vector3i>& triangles,
                                  const std::vector<Eigen::Vector3d>& from,
                                  const std::vector<Eigen::Vector3d>& to);

}  // namespace pliant
