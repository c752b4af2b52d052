#pragma once

#include <Eigen/Geometry>

#include "framework/geometry/camera.h"
#include "framework/geometry/pixel_window.h"

namespace pliant {

/// The window of a camera's image that an object moves with. Its size grows as the object comes nearer, by
/// more than is needed, so that this happens in few frames, and never shrinks: what is kept for its pixels
/// seldom needs new memory.
class FollowedWindow {
 public:
  /// `window`: shows the object at a pose; `depth`: of its middle there, mm.
  FollowedWindow(const Camera& camera, const PixelWindow& window, double depth,
                 const Eigen::Isometry3d& camera_from_model);

  /// Where the object is at another pose (mm); where it was last if that is behind the camera.
  const PixelWindow& move_to(const Eigen::Isometry3d& camera_from_model);
  /// It was found in this window.
  const PixelWindow& move_to(const PixelWindow& found);

 private:
  void cover(const Eigen::Vector2d& middle, double width, double height);

  Camera camera_;
  PixelWindow window_;
  Eigen::Vector3d middle_;  // of the object, mm, model's frame
  Eigen::Vector2d size_;    // of the window at the middle's depth, mm
};

}  // namespace pliant
