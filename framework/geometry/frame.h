#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// What an RGB-D camera saw at one moment. Colour and mask are empty or of the depth's size.
struct RgbdFrame {
  DepthImage depth;
  ColorImage color;
  MaskImage mask;
};

/// A source to be registered to a target, both seen by the same camera.
struct FramePair {
  std::string name;
  Camera camera;
  RgbdFrame source;
  RgbdFrame target;
  /// True motion in mm (camera frame) of the surface point seen at each source pixel; NaN where it is
  /// unknown; empty when nothing is known.
  Image<Eigen::Vector3f> scene_flow;
  /// What is odd about all this, though it can be used: a line each. They go into what is made of the pair.
  std::vector<std::string> warnings = {};
};

/// Throws DataError, which names the pair and both sizes, unless camera, images and truth fit together: every
/// image that is there has the camera's size, depth is there, focal lengths are positive and the principal
/// point is finite. What the depths are does not matter: see is_depth.
void check(const FramePair& pair);
/// The same without a look at the target.
void check_source(const FramePair& pair);

}  // namespace pliant
