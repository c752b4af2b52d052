#pragma once

#include <cstdint>
#include <vector>

#include "framework/device/array.h"
#include "framework/model/displacement_lattice.h"
#include "framework/model/reference_model.h"
#include "framework/model/tsdf_grid.h"

namespace pliant {

/// The distances and weights of a grid's voxels, x fastest.
struct TsdfVoxels {
  std::vector<std::int16_t> distances;  ///< in parts of the truncation (TsdfGrid::steps); 0: unobserved
  std::vector<std::uint8_t> weights;  ///< how many frames each distance is the mean of, at most the greatest
};

/// A truncated signed distance field on a dense grid [Newcombe et al., "KinectFusion: Real-time dense surface
/// mapping and tracking", ISMAR 2011]. The distance of a voxel is the depth that the map shows there less its
/// own, along the camera's axis, averaged over the frames. Three bytes a voxel.
///
/// What lies farther than the truncation before the surface is told of where something was observed, which it
/// wears away; elsewhere it stays unobserved, as what is hidden does: bricks without surface are passed over.
class Tsdf : public ReferenceModel {
 public:
  static constexpr int greatest_weight = 255;

  /// `max_weight`: from so many frames on, later ones weigh as if there had been no more; at most
  /// greatest_weight. The device must outlive this. Throws DeviceError when it has no room for the voxels.
  Tsdf(Device& device, const TsdfGrid& grid, int max_weight);

  void integrate(const DepthMap& depth, const Camera& camera, const Eigen::Isometry3d& camera_from_model,
                 int weight = 1) override;
  /// The same where the camera saw what is in the grid displaced: each voxel is told of from where it then
  /// is. `lattice`: of grid().
  void integrate(const DepthMap& depth, const Camera& camera, const Eigen::Isometry3d& camera_from_model,
                 const DisplacementLattice& lattice);
  const SurfaceMap& raycast(const Camera& camera, const PixelWindow& window,
                            const Eigen::Isometry3d& camera_from_model) override;
  Mesh mesh() const override;
  /// Forgets all frames.
  void clear();

  const TsdfGrid& grid() const { return grid_; }
  /// Copies the voxels to the host.
  TsdfVoxels read() const;

 private:
  void fuse(const DepthMap& depth, const Camera& camera, const Eigen::Isometry3d& camera_from_model,
            int weight, const DisplacementLattice* lattice);

  Device& device_;
  TsdfGrid grid_;
  int max_weight_;
  Buffer distances_, weights_;
  Buffer contents_;       // of each brick: see tsdf_grid.cl
  Buffer found_;          // bricks to be fused
  Array<float> bounds_;   // of depth, a tile of the map
  Array<cl_int> ranges_;  // of depth, a tile of the view
  SurfaceMap view_;
};

}  // namespace pliant
