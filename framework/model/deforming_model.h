#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/deformation/embedded_graph.h"
#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/surface_map.h"
#include "framework/imaging/depth_map.h"
#include "framework/model/reference_model.h"

namespace pliant {

/// What a non-rigid registration of the last view starts from, in the frame of that view's camera.
struct DeformationStart {
  const SurfaceMap& rest;  ///< points at rest, one a pixel of the view's window; valid until the next view
  std::vector<Eigen::Vector3f>
      nodes;            ///< mm, of the graph to be used; empty: any graph of the points will do
  Array<float> affine;  ///< their transforms so far (see warp.h); of no size without nodes
};

/// What it came to, in the same frame.
struct ModelDeformation {
  const EmbeddedGraph& graph;  ///< in the order of DeformationStart::nodes, where there were some
  const Array<float>& affine;  ///< affine_size numbers a node
  const SurfaceMap& moved;     ///< the points, deformed, one a pixel of the view's window
  int nearest_nodes = 4;       ///< k of [Eq. 4.1]
  Eigen::Isometry3d camera_from_model = Eigen::Isometry3d::Identity();  ///< mm, of the view that was deformed
  /// Where the model is after it: what all of the surface does is no deformation.
  Eigen::Isometry3d camera_from_model_after = Eigen::Isometry3d::Identity();
};

/// A reference model that takes up how its surface deforms [thesis 4.8]. Its frame of reference is that of
/// the camera of the first frame; the rigid motion is apart from what it takes up.
class DeformingModel {
 public:
  virtual ~DeformingModel() = default;

  /// Fuses a depth map that `camera` saw from where `camera_from_model` (mm) puts the model as it is deformed
  /// now. Only enqueues.
  virtual void integrate(const DepthMap& depth, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_model) = 0;
  /// What a camera would see of the model, as it is deformed now: points and normals in that camera's frame.
  /// Each belongs to some pixel of the window, not always to the one that it projects to. Valid until the
  /// next call. Only enqueues.
  virtual const SurfaceMap& view(const Camera& camera, const PixelWindow& window,
                                 const Eigen::Isometry3d& camera_from_model) = 0;
  /// Of the last view.
  virtual DeformationStart start() = 0;
  /// Takes up what registration made of the last start().
  virtual void deform(const ModelDeformation& deformation) = 0;

  /// Points of the surface as it is now, x y z each, mm, in the model's frame, which go with it from now on.
  virtual void follow(const Array<float>& points) = 0;
  /// Where they are; empty before the first.
  virtual const Array<float>& followed() const = 0;
  /// The whole surface as it is deformed now, mm, in the model's frame. Waits for the device.
  virtual Mesh mesh() const = 0;
};

/// How a reference model takes up a deformation.
class ModelUpdate {
 public:
  static constexpr const char* kind = "update";
  virtual ~ModelUpdate() = default;
  /// Around an empty model. The device must outlive what is returned.
  virtual std::unique_ptr<DeformingModel> make(Device& device,
                                               std::unique_ptr<ReferenceModel> model) const = 0;
};

/// Adds `reintegration` and `warp_field`.
void register_model_updates(Registry& registry);

}  // namespace pliant
