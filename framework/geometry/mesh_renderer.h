#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/true_motion.h"

namespace pliant {

/// What a camera sees of a mesh, as images that live on the device, row by row.
struct MeshView {
  Camera camera;
  Array<cl_int> triangles;  ///< index of the triangle that each pixel shows; -1: none
  Array<float> depth;       ///< mm along the optical axis; 0: none
  /// The shares of the triangle's second and third corner in the point seen, in turn; the first has the rest.
  Array<float> shares;
};

/// The motion of what each pixel of a view shows, as images that live on the device: see TrueMotion.
struct DeviceMotion {
  Array<float> scene_flow;    ///< x y z in turn
  Array<float> optical_flow;  ///< u v in turn
  Array<cl_uchar> visible;

  /// Copies all to the host; `camera` is that of the view that moved.
  TrueMotion read(const Camera& camera) const;
};

/// Renders one list of triangles by z-buffer on a device, as `render_mesh` does on the host, which is the
/// reference. Corners are rounded to 1/4096 of a pixel before it is decided which rays meet a triangle: only
/// pixels that see an edge from so near may differ from the reference. Shared edges leave no gaps, also here.
/// Depth is exact to what float can hold of it. Vertices: x y z in turn, mm in the camera's frame.
class MeshRenderer {
 public:
  /// Throws std::invalid_argument when there is no triangle or one names a vertex that does not exist. The
  /// device must outlive this.
  MeshRenderer(Device& device, const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices);

  /// Points nearer than `near` mm, > 0, are not seen.
  MeshView render(const Array<float>& vertices, const Camera& camera, float near = 1) const;

  /// Three values per vertex, interpolated to what each pixel shows: three per pixel, 0 where there is
  /// nothing.
  Array<float> interpolate(const MeshView& view, const Array<float>& values) const;

  /// The motion of what `from` shows while the vertices go to those that `to` shows, each in its own camera's
  /// frame.
  DeviceMotion move(const MeshView& from, const Array<float>& to_vertices, const MeshView& to) const;

 private:
  void check(const Array<float>& values) const;

  Device& device_;
  Array<cl_int> triangles_;
  std::size_t vertices_;
};

}  // namespace pliant
