#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "framework/geometry/frame.h"
#include "framework/geometry/pixel_window.h"

namespace pliant::bench {

/// One stage of a tracked frame, ours and OpenCV's on the same images. Each runs until its result is there.
struct StagePair {
  std::string stage;  ///< "bilateral", "normals", "icp", "integrate" or "raycast"
  std::function<void()> ours;
  std::function<void()> opencv;
};

/// Two frames of a moving camera, as the camera gives them, and what is tracked in them.
struct TrackedImages {
  Rig rig;
  Frame before;
  Frame after;
  Eigen::Isometry3d after_from_before;  ///< the true motion of the camera's frames, mm
  PixelWindow region;                   ///< of the image, that is tracked
  double depth_cut;                     ///< mm; 0: nothing is cut
};

}  // namespace pliant::bench
