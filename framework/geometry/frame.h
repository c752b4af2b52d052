#pragma once

#include <string>
#include <vector>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"
#include "framework/geometry/rig.h"

namespace pliant {

/// What a rig saw at one moment. Colour and mask may be empty; the mask has the depth's size, the colour that
/// of the colour camera or, without one, the depth's.
struct Frame {
  DepthImage depth;
  ColorImage color;
  MaskImage mask;
  double time = 0;  ///< seconds, from any moment on
};

/// A source to be registered to a target, both seen by the same camera, colour at the depth's pixels.
struct FramePair {
  std::string name;
  Camera camera;
  Frame source;
  Frame target;
  /// What is odd about all this, though it can be used: a line each. They go into what is made of the pair.
  std::vector<std::string> warnings = {};
};

/// Throws DataError unless a frame fits the rig: depth is there, and every image that is there has its
/// camera's size. The message begins with `whose`, as in "pair: the source's", and names both sizes. What the
/// depths are does not matter: see is_depth.
void check(const Frame& frame, const Rig& rig, const std::string& whose);

/// The same for both frames of a pair, and for its camera.
void check(const FramePair& pair);
/// The same without a look at the target.
void check_source(const FramePair& pair);

}  // namespace pliant
