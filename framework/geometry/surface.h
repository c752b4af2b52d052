#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// The points of a depth map as a list, in row-major order of their pixels. Points in mm in the camera's
/// frame; unit normals that face the camera, (0, 0, 0) where the neighbourhood gives none.
struct Surface {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector2i> pixels;
  std::vector<Rgb> colors;  ///< empty without a colour image

  std::size_t size() const { return points.size(); }
};

/// The points of a depth map as images: a target for projective matching. A pixel without a point is
/// (0, 0, 0) in both.
struct SurfaceImage {
  Image<Eigen::Vector3f> points;
  Image<Eigen::Vector3f> normals;
};

/// Whether that is a point: finite, and not one of the zeros that stand where there is none.
inline bool is_point(const Eigen::Vector3f& point) { return point.allFinite() && point.z() > 0; }

/// The window over which normals are fitted.
inline constexpr int default_normal_radius = 2;
inline constexpr float default_depth_step = 30;  // mm
/// Where depth is sparse, the window grows up to this.
inline constexpr int widest_normal_radius = 8;
/// Fewest points of a window that give a normal: the centre and three neighbours.
inline constexpr int fewest_plane_points = 4;
/// Of the two spreads (variances) within the plane, the smaller one over the larger: below it the points lie
/// on a line, and every plane through it fits. Single precision still resolves it.
inline constexpr float flattest_spread = 1e-5F;

/// Least part of a unit normal along the viewing ray (x, y, 1). The pixels of a window that come to less lie
/// on one line, as where only single rows have depth: their points are in one plane with the camera, which
/// says nothing of the surface.
inline constexpr float edge_on = 0.01F;

/// Depth to points and normals, in plain C++ (depth_map.h does it on a device). Only pixels of which
/// `is_depth` holds count, and only those inside the mask where there is one. A normal comes from the plane
/// fitted to the valid points of the (2 radius + 1)^2 window whose depth differs from the centre's by less
/// than `depth_step` mm [thesis 3.1]; at least three neighbours are needed.
SurfaceImage make_surface_image(const Frame& frame, const Camera& camera, int radius = default_normal_radius,
                                float depth_step = default_depth_step);

/// The valid points of a map as a list, with colours from `color` when that is not empty.
Surface make_surface(const SurfaceImage& map, const ColorImage& color);

}  // namespace pliant
