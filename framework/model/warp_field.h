#pragma once

#include <memory>
#include <optional>

#include "framework/model/deforming_model.h"
#include "framework/model/node_field.h"
#include "framework/model/tsdf.h"

namespace pliant {

/// A signed distance field that never deforms, and a field of nodes that moves what is in it [Newcombe, Fox
/// and Seitz, "DynamicFusion: Reconstruction and tracking of non-rigid scenes in real-time", CVPR 2015]:
/// frames are fused from where the field takes the voxels, views are what a ray meets at rest, moved by it.
/// Nodes have affine forms [Eq. 4.1]. Until it has been deformed it is its signed distance field, bit for
/// bit.
class WarpField : public DeformingModel {
 public:
  /// `node_spacing`: mm from node to node about. The device must outlive this.
  WarpField(Device& device, std::unique_ptr<Tsdf> canonical, double node_spacing);

  void integrate(const DepthMap& depth, const Camera& camera,
                 const Eigen::Isometry3d& camera_from_model) override;
  const SurfaceMap& view(const Camera& camera, const PixelWindow& window,
                         const Eigen::Isometry3d& camera_from_model) override;
  /// Adds nodes where the view shows more than there are nodes for, which waits for the device. Throws
  /// std::logic_error before the first view.
  DeformationStart start() override;
  /// The graph's nodes are those of the last start(); its k is the field's from now on. Throws
  /// std::invalid_argument for other nodes, NumericalError for a pose that is not finite.
  void deform(const ModelDeformation& deformation) override;

  /// Once there is a deformation, see points_at_rest() for how large it may be.
  void follow(const Array<float>& points) override;
  const Array<float>& followed() const override { return followed_.now(); }
  Mesh mesh() const override;

  const Tsdf& canonical() const { return *canonical_; }
  const NodeField& field() const { return field_; }  ///< in the model's frame

 private:
  void warp_view();
  void update_lattice();
  std::vector<Eigen::Vector3f> points_in_view() const;

  Device& device_;
  std::unique_ptr<Tsdf> canonical_;
  double node_spacing_;
  NodeField field_;
  bool is_deformed_ = false;
  std::optional<DisplacementLattice> lattice_;  // once there is a deformation
  CarriedPoints lattice_points_;
  bool lattice_is_current_ = false;
  const SurfaceMap* rest_ = nullptr;                                     // of the last view
  Eigen::Isometry3d camera_from_model_ = Eigen::Isometry3d::Identity();  // likewise
  SurfaceMap view_;
  CarriedPoints followed_;
};

/// Adds `warp_field`.
void register_warp_field(Registry& registry);

}  // namespace pliant
