#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "experiments/modeller/figure.h"
#include "experiments/training/draw.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// What of a view a pixel shows.
enum class Shown : std::uint8_t { nothing, head, other };

/// A head as a depth camera sees it.
struct HeadView {
  DepthImage depth;    ///< mm, with the noise of the first Kinect
  Image<Shown> shown;  ///< `head`: above the neck; of what a pixel showed before noise
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();  ///< mm
};

/// What views are drawn from.
struct HeadViewOptions {
  double nearest = 500;  ///< mm from the camera's plane to the head's centre
  double farthest = 1300;
  Eigen::Vector3d greatest_angles{60, 40, 25};  ///< degrees: yaw, pitch, roll; see head_rotation
  double variety = 1;                           ///< see vary_head
  double company = 0.5;  ///< how likely there are shoulders, and something before or behind the head
  double noise = 1;      ///< of the sensor, 1 as the camera
};

/// The camera of views: 640x480 pixels at 525 pixels, as that of the first Kinect.
Camera head_camera();

/// Draws views of a few heads, and of what is no head.
class HeadViews {
 public:
  HeadViews(std::vector<Figure> heads, const HeadViewOptions& options);

  HeadView draw(Draw& draw) const;

 private:
  std::vector<Figure> heads_;
  HeadViewOptions options_;
};

/// A view of a figure that is no head, a hand say: `shown` is never `head`.
HeadView draw_figure(const Figure& figure, const HeadViewOptions& options, Draw& draw);

}  // namespace pliant
