#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// A surface as a camera sees it, as images that live on the device: x y z per pixel of a window of the
/// camera's image, row by row, (0, 0, 0) where there is no point. Outside of the window there is none. A
/// point or normal that is not finite counts as none.
struct SurfaceMap {
  Camera camera;
  PixelWindow window;
  PointSet map;  ///< mm, camera frame; normals of unit length, or (0, 0, 0)

  /// `map`: one point a pixel of the window.
  SurfaceMap(const Camera& camera, const PixelWindow& window, PointSet map);
  /// Over the whole image.
  SurfaceMap(const Camera& camera, const SurfaceImage& image);

  const Array<float>& points() const { return map.points; }
  const Array<float>& normals() const { return map.normals; }
};

/// `source` behind lanes.cl and surface_map.cl: what kernels over maps share.
std::string with_surface_map(std::string_view source);

/// The arguments that kernels over a map take: fx, fy, cx, cy; and left, top, width and height of its window,
/// then width and height of the camera's image.
cl_float4 pinhole(const Camera& camera);
cl_int8 frame_of(const SurfaceMap& map);

/// A vector of a map for plain C++ references: (0, 0, 0) unless it is finite and so is its square.
Eigen::Vector3f finite_or_none(const Array<float>& vectors, std::size_t index);
/// The same by pixel of the camera's image: (0, 0, 0) also outside of the window. `vectors`: of the map.
Eigen::Vector3f finite_or_none(const SurfaceMap& map, const Array<float>& vectors,
                               const Eigen::Vector2i& pixel);

/// The mean of the points there are, mm, camera frame; none without any. Waits for the device.
std::optional<Eigen::Vector3d> middle_of(const SurfaceMap& map);

/// Plain C++ reference of projection: the pixel that a point (mm, camera frame) projects to; none outside of
/// the image.
std::optional<Eigen::Vector2i> pixel_reference(const Camera& camera, const Eigen::Vector3f& point);

/// Plain C++ reference of projective association [thesis 4.2]: offset, in the map's window, of the pixel that
/// the point (mm, camera frame) projects to; none when that has no point.
std::optional<std::size_t> seen_pixel_reference(const SurfaceMap& map, const Eigen::Vector3f& point);

}  // namespace pliant
