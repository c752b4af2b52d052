#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// A depth image for kernels over windows: rows of `stride` values, ringed by `halo` pixels without depth.
/// A pixel has depth where `is_depth` of it holds and the mask, if there is one, is not zero; elsewhere
/// stands `no_depth`.
struct DepthMap {
  static constexpr int halo = 16;                    ///< a whole vector, so that rows stay aligned
  static constexpr float no_depth = farthest_depth;  ///< further than any depth step

  int width = 0;
  int height = 0;
  int stride = 0;
  Array<float> depth;  ///< mm

  /// An uninitialised map of the size of an image.
  DepthMap(int width, int height);
  /// Throws std::invalid_argument when mask and depth differ in size.
  explicit DepthMap(const Frame& frame);

  std::size_t offset(int u, int v) const {
    return static_cast<std::size_t>(v + halo) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(u + halo);
  }
  int rows() const { return height + 2 * halo; }
};

/// The same as an image, 0 where there is no depth.
DepthImage to_image(const DepthMap& map);

/// Row-major offsets of the pixels with depth, ascending.
std::vector<int> pixels_with_depth(const DepthMap& map);

/// Widest window that fits into the halo.
inline constexpr int max_window_radius = DepthMap::halo;

/// What make_surface_map of surface.h does, on the device: x y z of each pixel, row-major, (0, 0, 0) where
/// there is none. Only enqueues. `radius` is at most max_window_radius.
PointSet make_surface_map(Device& device, const DepthMap& map, const Camera& camera,
                          int radius = default_normal_radius, float depth_step = default_depth_step);

/// What make_surface_image of surface.h does, made on the device.
SurfaceImage make_surface_image(Device& device, const Frame& frame, const Camera& camera);

}  // namespace pliant
