#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/geometry/frame.h"
#include "framework/geometry/mesh_renderer.h"
#include "framework/geometry/rig.h"
#include "framework/io/surface_mesh.h"

namespace pliant {

/// Draws a virtual object over colour images, fixed to a tracked surface and hidden by what is before it: the
/// markerless augmented reality that the thesis is for [thesis 3].
class Augmentation {
 public:
  struct Object {
    SurfaceMesh mesh;  ///< mm, in a frame of its own, with a colour for every vertex
    /// From the object's frame to that of the tracked model, mm.
    Eigen::Affine3d model_from_object = Eigen::Affine3d::Identity();
  };

  /// `tolerance`: mm that measured depth may be before the object without hiding it, so that noise does not
  /// wear holes into what touches the surface. The device must outlive this. Throws std::invalid_argument
  /// when a triangle names a vertex that does not exist or there are not as many colours as vertices.
  Augmentation(Device& device, Object object, const Rig& rig, double tolerance);

  /// The frame's colour image with the object drawn where it is nearer to the colour camera than what the
  /// depth shows, and where no depth was measured. `camera_from_model` (mm): where the model, or the part of
  /// it that carries the object, is in the depth camera's frame. Depth is taken to a colour camera of its own
  /// by depth_at_color; a mask plays no part. The object is lit from the colour camera (Lambert), both sides
  /// alike. Throws DataError for a frame without colour. The frame must fit the rig (`check`).
  ColorImage draw(const Frame& frame, const Eigen::Isometry3d& camera_from_model) const;

  /// The object's origin, mm, in the model's frame.
  Eigen::Vector3d anchor() const { return object_.model_from_object.translation(); }

 private:
  /// Of every vertex, in the frame that `vertices` are in: r g b in turn.
  Array<float> shaded(const std::vector<Eigen::Vector3f>& vertices) const;

  Object object_;
  Rig rig_;
  double tolerance_;
  MeshRenderer renderer_;
};

}  // namespace pliant
