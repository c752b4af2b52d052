#pragma once

#include "framework/core/registry.h"
#include "framework/imaging/depth_map.h"

namespace pliant {

/// Makes points and normals of a depth map [thesis 3.1].
class Normals {
 public:
  static constexpr const char* kind = "normals";
  virtual ~Normals() = default;
  /// Writes points and normals (camera frame) of the map's window into `surface`, which has that window and
  /// camera; makes no buffer after the first call. Only enqueues.
  virtual void write(Device& device, const DepthMap& map, SurfaceMap& surface) const = 0;
};

/// Adds `plane_fit`, `integral_images` and `cross_product`.
void register_normals(Registry& registry);

}  // namespace pliant
