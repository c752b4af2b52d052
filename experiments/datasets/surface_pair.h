#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "experiments/datasets/frame_source.h"
#include "framework/core/registry.h"

namespace pliant {

/// Two surfaces from files, each seen by one virtual depth camera. Depth is exact; colour is that of the
/// vertices where both files have any.
class SurfacePair : public FrameSource {
 public:
  struct Settings {
    std::string source;  ///< PLY or OBJ files
    std::string target;
    double unit = 1;  ///< mm a unit of the files
    /// Vertex by vertex and triangle by triangle the same surface: what moves is known exactly.
    bool corresponding = false;
    Camera camera;
    /// From the frame of the surfaces, mm, to the camera's (x right, y down, z forward). By default the
    /// camera stands where a surface that is upright along y and looks along +z looks at it, after `turn`, in
    /// the middle.
    std::optional<Eigen::Isometry3d> camera_from_surface = std::nullopt;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    std::optional<double> distance =
        std::nullopt;  ///< mm to the middle; both surfaces just fill the image by default
  };

  explicit SurfacePair(Settings settings) : settings_(std::move(settings)) {}

  /// Neither device nor seed play a part. Throws DataError naming the file that cannot be read, that the
  /// camera does not see, or that is not the same surface as it should be.
  std::unique_ptr<DataStream> open(Device& device, std::uint64_t seed) const override;

 private:
  Settings settings_;
};

void register_surface_pair(Registry& registry);

}  // namespace pliant
