#pragma once

#include <memory>
#include <optional>
#include <string>

#include "experiments/datasets/frame_files.h"
#include "experiments/datasets/frame_source.h"
#include "framework/core/registry.h"

namespace pliant {

/// Two RGB-D images from files, with what is known about them. Paths are empty where there is no file.
class RgbdPair : public FrameSource {
 public:
  struct Settings {
    FrameFiles source;
    FrameFiles target;
    std::string intrinsics;
    /// Of a colour camera apart from the depth camera; empty: colour has the depth's pixels.
    std::string color_intrinsics;
    /// From the depth camera's frame to the colour camera's, mm; plays no part without color_intrinsics.
    Eigen::Isometry3d color_from_depth = Eigen::Isometry3d::Identity();
    std::string scene_flow;
    double depth_scale = 1;           ///< mm a unit of the depth images
    std::optional<double> max_depth;  ///< mm; farther depth is dropped
  };

  explicit RgbdPair(Settings settings) : settings_(std::move(settings)) {}

  /// Gives depth images of one size, and colour images of one, with at least one point in the source and in
  /// the target, and with truth, where there is a file of it, for at least one point of the source. What is
  /// odd about depth or intrinsics is among the stream's warnings. The seed plays no part.
  std::unique_ptr<DataStream> open(Device& device, std::uint64_t seed) const override;

 private:
  Settings settings_;
};

void register_rgbd_pair(Registry& registry);

}  // namespace pliant
