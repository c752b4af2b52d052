#pragma once

#include <algorithm>
#include <vector>

#include "experiments/view/tracked_frame.h"

namespace pliant::test {

/// A wall 700 mm before the camera, seen in a window of its image; the model of it lies 4 mm behind in the
/// window's left half. Both have no point in the window's first column.
class SampleTracked {
 public:
  SampleTracked() : seen_(wall(0)), model_(wall(4)) {
    frame.depth = DepthImage(camera.width, camera.height, 900);
    record.number = 7;
    record.state = FrameState::tracked;
    record.pose.mean_error = 1.25;
    record.pose.samples = 1600;
    record.pose.inliers = 1234;
  }

  TrackedFrame tracked() const { return {frame, frame.color, record, &seen_, &model_}; }
  TrackedFrame waiting() const { return {frame, frame.color, record, nullptr, nullptr}; }

  static constexpr PixelWindow window{20, 10, 40, 40};
  const Camera camera{70, 70, 39.5, 29.5, 80, 60};
  Frame frame;
  FrameRecord record;

 private:
  /// `behind`: mm, of its left half.
  SurfaceMap wall(float behind) const {
    std::vector<Eigen::Vector3f> points;
    std::vector<Eigen::Vector3f> normals;
    for (int v = 0; v < window.height; ++v)
      for (int u = 0; u < window.width; ++u) {
        const double z = 700 + (u < window.width / 2 ? behind : 0);
        const bool is_there = u > 0;
        const Eigen::Vector3d point = camera.unproject(window.left + u, window.top + v, z);
        points.emplace_back((is_there ? 1.0F : 0.0F) * point.cast<float>());
        normals.emplace_back(0, 0, is_there ? -1 : 0);
      }
    return {camera, window, PointSet{flatten(points), flatten(normals)}};
  }

  SurfaceMap seen_;
  SurfaceMap model_;
};

/// How many different colours a part of a picture shows.
inline std::size_t colors_in(const ColorImage& picture, const PixelWindow& part) {
  std::vector<int> colors;
  for (int v = part.top; v < part.top + part.height; ++v)
    for (int u = part.left; u < part.left + part.width; ++u)
      colors.push_back(picture(u, v).r << 16 | picture(u, v).g << 8 | picture(u, v).b);
  std::sort(colors.begin(), colors.end());
  return static_cast<std::size_t>(std::unique(colors.begin(), colors.end()) - colors.begin());
}

}  // namespace pliant::test
