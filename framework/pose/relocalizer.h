#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/rig.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// Finds a model again that moved further than ICP reaches [thesis 3.3]. Bound to a device and a rig.
class Relocalizer {
 public:
  virtual ~Relocalizer() = default;

  /// A frame whose pose (mm) was found: later ones may be found by it. `seen`: its surface.
  virtual void remember(const Frame& frame, const SurfaceMap& seen,
                        const Eigen::Isometry3d& camera_from_model) = 0;
  /// Where the model may be in a frame, camera_from_model (mm): the likeliest first, a few at most; none
  /// where nothing tells. Each is only a start for ICP, which judges it.
  virtual std::vector<Eigen::Isometry3d> candidates(const Frame& frame, const SurfaceMap& seen) = 0;
};

/// Makes the relocalizer of an experiment.
class RelocalizerKind {
 public:
  static constexpr const char* kind = "relocalizer";
  virtual ~RelocalizerKind() = default;
  /// Null for `none`. Both must outlive what is returned.
  virtual std::unique_ptr<Relocalizer> make(Device& device, const Rig& rig) const = 0;
};

/// Adds `none`, `features` and `head_forest`.
void register_relocalizers(Registry& registry);

}  // namespace pliant
