#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// A surface as a camera sees it, as images that live on the device: x y z per pixel, row-major, (0, 0, 0)
/// where there is no point. A point or normal that is not finite counts as none.
struct SurfaceMap {
  Camera camera;
  Array<float> points;   ///< mm, camera frame
  Array<float> normals;  ///< unit length, or (0, 0, 0)

  /// `map`: one point a pixel of the camera.
  SurfaceMap(const Camera& camera, PointSet map);
  SurfaceMap(const Camera& camera, const SurfaceImage& image);
};

/// `source` behind lanes.cl and surface_map.cl: what kernels over maps share.
std::string with_surface_map(std::string_view source);

/// The arguments that kernels over a map take: fx, fy, cx, cy and width, height.
cl_float4 pinhole(const Camera& camera);
cl_int2 image_size(const Camera& camera);

/// A vector of a map for plain C++ references: (0, 0, 0) unless it is finite and so is its square.
Eigen::Vector3f finite_or_none(const Array<float>& vectors, std::size_t index);

/// Plain C++ reference of projection: row-major offset of the pixel that a point (mm, camera frame) projects
/// to; none outside of the image.
std::optional<std::size_t> pixel_reference(const Camera& camera, const Eigen::Vector3f& point);

/// Plain C++ reference of projective association [thesis 4.2]: row-major offset of the pixel that the point
/// (mm, camera frame) projects to; none when that lies outside or has no point.
std::optional<std::size_t> seen_pixel_reference(const SurfaceMap& map, const Eigen::Vector3f& point);

}  // namespace pliant
