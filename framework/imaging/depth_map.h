#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/surface.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// What a depth image shows, for kernels over windows: rows of `stride` values, ringed by `halo` pixels
/// without depth. Outside of its window the image shows nothing. A pixel has depth where `is_depth` of it
/// holds and the mask, if there is one, is not zero; elsewhere stands `no_depth`.
struct DepthMap {
  static constexpr int halo = 16;                    ///< a whole vector, so that rows stay aligned
  static constexpr float no_depth = farthest_depth;  ///< further than any depth step

  PixelWindow window;
  int stride = 0;
  Array<float> depth;  ///< mm

  /// An uninitialised map.
  explicit DepthMap(const PixelWindow& window);
  /// In the smallest window that holds all depth. Throws std::invalid_argument when mask and depth differ in
  /// size.
  explicit DepthMap(const Frame& frame);

  /// Puts what a frame shows in the window in place of what was there, without depths beyond `farthest` mm.
  /// The window lies within the frame. Throws std::invalid_argument when mask and depth differ in size.
  void take(const Frame& frame, float farthest = no_depth);

  /// Of a pixel by its place in the window.
  std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row + halo) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(column + halo);
  }
  int rows() const { return window.height + 2 * halo; }
};

/// The same as an image of the camera, 0 where there is no depth.
DepthImage to_image(const DepthMap& map, const Camera& camera);

/// Offsets in the window of the pixels with depth, ascending.
std::vector<int> pixels_with_depth(const DepthMap& map);

/// Widest window that fits into the halo.
inline constexpr int max_window_radius = DepthMap::halo;

/// A surface that a device will write.
SurfaceMap unwritten_surface(const Camera& camera, const PixelWindow& window);

/// What make_surface_image of surface.h does, on the device, in the map's window. Only enqueues. `radius` is
/// at most max_window_radius.
SurfaceMap make_surface_map(Device& device, const DepthMap& map, const Camera& camera,
                            int radius = default_normal_radius, float depth_step = default_depth_step);

/// What make_surface_image of surface.h does, made on the device.
SurfaceImage make_surface_image(Device& device, const Frame& frame, const Camera& camera);

}  // namespace pliant
