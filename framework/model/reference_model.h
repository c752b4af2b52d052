#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "framework/core/registry.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/surface_map.h"
#include "framework/imaging/depth_map.h"

namespace pliant {

/// The surface that frames are fused into [thesis 3.2], on one device. Its frame of reference is the model's:
/// that of the camera of the first frame.
class ReferenceModel {
 public:
  virtual ~ReferenceModel() = default;

  /// Fuses a depth map that `camera` saw from where `camera_from_model` (mm) puts the model, as if `weight`
  /// frames had shown it. Only enqueues.
  virtual void integrate(const DepthMap& depth, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_model, int weight = 1) = 0;
  /// What a camera would see of the model from there, in the window: points and normals in that camera's
  /// frame. Valid until the next call. Only enqueues.
  virtual const SurfaceMap& raycast(const Camera& camera, const PixelWindow& window,
                                    const Eigen::Isometry3d& camera_from_model) = 0;
  /// The whole surface, mm, in the model's frame. Waits for the device.
  virtual Mesh mesh() const = 0;
};

/// Makes the reference model of an experiment.
class ModelKind {
 public:
  static constexpr const char* kind = "model";
  virtual ~ModelKind() = default;
  /// An empty model. `seen`: what the first frame shows of what is to be modelled, in the frame of its
  /// camera, which is the model's; the model may be fitted to it. Throws DataError when there is nothing to
  /// fit it to, DeviceError when the device has no room for it.
  virtual std::unique_ptr<ReferenceModel> make(Device& device, const SurfaceMap& seen) const = 0;
};

/// Adds `tsdf`.
void register_models(Registry& registry);

}  // namespace pliant
