#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"
#include "framework/geometry/render.h"

namespace pliant {

/// A point counts as hidden by what is nearer to the camera by this, in mm, and a quarter of the size of a
/// pixel at the point's depth.
inline constexpr double nearest_hiding = 0.5;
inline constexpr double hiding_pixels = 0.25;
/// A surface that is steeper to the image than so : 1 is taken for one as steep.
inline constexpr double steepest_hiding_slope = 8;

/// The motion of the material point that each pixel of a view shows until another view is taken.
struct TrueMotion {
  /// mm, from the point in the first camera's frame to the point in the second one's; NaN where nothing is
  /// seen.
  Image<Eigen::Vector3f> scene_flow;
  /// Pixels, from where the first camera sees the point to where it would be in the second one's image; NaN
  /// also where it is then behind the camera.
  Image<Eigen::Vector2f> optical_flow;
  /// 1 where the second view shows the point: see is_shown.
  MaskImage visible;
};

/// Whether a view whose depth is `depth` (mm, 0: nothing) shows a point of a surface with this normal (of any
/// length): at the pixel it projects to, the view shows the plane of its surface, and at none of the four
/// pixels around it anything before that plane. What is nearer to the plane than hides a point (see above) is
/// taken for it.
bool is_shown(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const Camera& camera,
              const DepthImage& depth);

/// The motion of what `seen`, the rendering of `from`, shows, while the vertices go to `to`; `target` is the
/// depth of the rendering of `to`. Vertices: mm in the frames of their cameras.
TrueMotion true_motion(const Image<Fragment>& seen, const std::vector<Eigen::Vector3i>& triangles,
                       const Camera& from_camera, const std::vector<Eigen::Vector3d>& to,
                       const Camera& to_camera, const DepthImage& target);

}  // namespace pliant
