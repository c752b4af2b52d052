#pragma once

#include <vector>

#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/pixel_window.h"
#include "framework/geometry/point_set.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Which point of a surface is seen at each pixel of the bounding box of its projection.
struct PixelIndex {
  PixelWindow window;     ///< the box
  Array<int> points;      ///< of each pixel, row by row, the index of the point; -1 where there is none
  std::size_t count = 0;  ///< of points

  /// `pixels`: of each point, its offset in the window.
  PixelIndex(const PixelWindow& window, const std::vector<int>& pixels);
};

PixelIndex index_pixels(const Surface& surface);

/// A surface as graph builders and samplers see it, who choose from its points.
struct SurfaceView {
  const PixelIndex& pixels;
  const PointSet& points;  ///< mm, camera frame; on the device
  const Camera& camera;
};

/// Pixels of an image from (left, top) to before (right, bottom).
struct PixelBox {
  int left, top, right, bottom;
};

/// How far from a pixel in a gap of sparse depth a point is looked for, in pixels. As in quadtree.cl.
inline constexpr int gap_radius = 3;

/// The point seen at a pixel of the camera's image. In a gap between points, as sparse depth and single lines
/// that are missing leave them, the nearest point of the box that is at most `gap_radius` pixels away in u
/// and v, the first one in row-major order on a tie. It is a gap where points lie in all four quadrants
/// around the pixel, within that distance and the axes included; outside the object they do not. -1 where
/// there is none.
int point_at(const PixelIndex& index, const Eigen::Vector2i& pixel, const PixelBox& box);

/// The points of the surface, by index and ascending, at the centres (see point_at) of `step` x `step` pixel
/// masks that tile its image from the top left corner.
std::vector<int> points_on_grid(const PixelIndex& index, int step);

/// The same with the step that gives most nearly `wished` points; the wider one on a tie, and the widest that
/// comes within a twentieth. What is so many points apart on an object is the same distance on it whatever
/// the camera's resolution, focal length and distance.
std::vector<int> about_as_many_points_on_grid(const PixelIndex& index, int wished);

}  // namespace pliant
