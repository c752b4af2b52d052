#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "experiments/datasets/frame_source.h"
#include "framework/core/registry.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/render.h"

namespace pliant {

/// A mesh with morph targets, seen by a depth camera with one expression as the source and another, after a
/// rigid motion, as the target. The middle of the mesh is on the optical axis and looks at the camera, its
/// y axis up. There is no background. Without noise the depth of every pixel is exact (not rounded to whole
/// millimetres); the scene flow is the exact motion of the material seen at each source pixel, also under
/// noise and where the target hides it.
class RenderedMesh : public FrameSource {
 public:
  struct Settings {
    std::string mesh;          ///< path of a .glb file
    double mesh_scale = 1000;  ///< mm a unit of the file
    // Expressions: morph targets and their weights as "name=weight".
    std::vector<std::string> identity;  ///< of source and target alike
    std::vector<std::string> source;
    std::vector<std::string> target;
    /// Of the target, in the camera's frame about the middle of the mesh.
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
    Camera camera;
    double distance = 700;  ///< mm along the optical axis to the middle of the mesh
    double noise = 0;       ///< strength of the KinectNoise on both depth images
    /// Share of the columns that the target covers, 0 <= share < 1, whose depth it lacks, from its left.
    double hide_left = 0;
  };

  /// Reads the mesh. Throws DataError when it cannot, ConfigError for an expression that the mesh does not
  /// have or that is not written as above.
  explicit RenderedMesh(Settings settings);

  /// The seed is that of the noise. Throws DataError, with the size of the mesh, when no pixel sees it or the
  /// camera is inside of it.
  std::unique_ptr<DataStream> open(Device& device, std::uint64_t seed) const override;

 private:
  std::vector<double> weights_of(const std::string& key, const std::vector<std::string>& expression) const;
  Eigen::AlignedBox3d box() const;
  Eigen::Affine3d placement() const;
  std::string size_and_unit() const;
  void check_is_seen(const Image<Fragment>& seen, const char* which) const;

  Settings settings_;
  Mesh mesh_;
  std::vector<double> identity_;  // weights of the morph targets
  std::vector<double> source_;
  std::vector<double> target_;
};

void register_rendered_mesh(Registry& registry);

}  // namespace pliant
