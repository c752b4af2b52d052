#include "experiments/datasets/depth_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "framework/geometry/has_point.h"
#include "framework/geometry/surface.h"

namespace pliant {
namespace {

std::vector<float> depths_of(const Frame& frame) {
  std::vector<float> depths;
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    if (has_point(frame, i)) depths.push_back(frame.depth.pixels()[i]);
  return depths;
}

/// The scale that would bring a depth, as it is counted in the file, where depth cameras see.
const char* likely_scale(double median) {
  if (median > 50000) return "0.1 (tenths of a millimetre)";
  if (median > 10000) return "0.2 (5000 units a metre, as TUM's)";
  if (median >= 100) return "1 (millimetres)";
  return median > 10 ? "10 (centimetres)" : "1000 (metres)";
}

std::string doubt_about_unit(std::vector<float> depths, double depth_scale, const std::string& path) {
  constexpr double nearest = 100;
  constexpr double farthest = 10000;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  const double median = *middle;
  if (median < nearest || median > farthest)
    return fmt::format(
        "{}: the median depth is {:g} mm, {} than cameras see; if the file counts in another unit, say which "
        "by "
        "depth_scale, mm a unit, now {:g}: perhaps {}",
        path, median, median < nearest ? "nearer" : "farther", depth_scale,
        likely_scale(median / depth_scale));
  constexpr double tum_scale = 0.2;
  constexpr double nearest_of_kinect = 400;
  if (depth_scale == tum_scale && median < nearest_of_kinect)
    return fmt::format(
        "{}: the median depth is {:g} mm, nearer than a Kinect sees; if the file counts millimetres and not "
        "5000 "
        "units a metre, depth_scale is 1",
        path, median);
  const bool is_in_fives = depth_scale == 1 && std::all_of(depths.begin(), depths.end(), [](float depth) {
                             return std::fmod(depth, 5.0F) == 0;
                           });
  std::sort(depths.begin(), depths.end());
  const auto levels = std::unique(depths.begin(), depths.end()) - depths.begin();
  constexpr int telling = 20;  // as many by chance are one in 5^20
  if (!is_in_fives || levels < telling) return "";
  return fmt::format(
      "{}: all depths are multiples of 5, as in files that count 5000 units a metre (TUM's); if it does, "
      "depth_scale is 0.2",
      path);
}

/// Sums over all pixels above and left of each corner of a pixel.
Image<int> summed_points(const Frame& frame) {
  const int width = frame.depth.width();
  Image<int> sums(width + 1, frame.depth.height() + 1, 0);
  for (int v = 0; v < frame.depth.height(); ++v) {
    int row = 0;
    for (int u = 0; u < width; ++u) {
      row += has_point(frame, static_cast<std::size_t>(v) * width + u) ? 1 : 0;
      sums(u + 1, v + 1) = sums(u + 1, v) + row;
    }
  }
  return sums;
}

/// The share of points in whose window lie too few points for a normal.
double lonely_share(const Frame& frame, const Image<int>& sums, int radius) {
  const int width = frame.depth.width();
  const int height = frame.depth.height();
  int lonely = 0;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (!has_point(frame, static_cast<std::size_t>(v) * width + u)) continue;
      const int left = std::max(u - radius, 0);
      const int top = std::max(v - radius, 0);
      const int right = std::min(u + radius + 1, width);
      const int bottom = std::min(v + radius + 1, height);
      const int count = sums(right, bottom) - sums(left, bottom) - sums(right, top) + sums(left, top);
      lonely += count < fewest_plane_points ? 1 : 0;
    }
  }
  return static_cast<double>(lonely) / sums(width, height);
}

std::string doubt_about_density(const Frame& frame, const std::string& path) {
  const Image<int> sums = summed_points(frame);
  const double without = lonely_share(frame, sums, widest_normal_radius);
  if (without > 0.5)
    return fmt::format(
        "{}: {:.0f}% of the points have fewer than three others within {} pixels, so that they have no "
        "normals: "
        "only distance judges their matches",
        path, 100 * without, widest_normal_radius);
  const double sparse = lonely_share(frame, sums, default_normal_radius);
  if (sparse <= 0.5) return "";
  return fmt::format(
      "{}: the depth is sparse: {:.0f}% of the points have fewer than three others within {} pixels; normals "
      "come "
      "from up to {} pixels away, and matches are as coarse",
      path, 100 * sparse, default_normal_radius, widest_normal_radius);
}

}  // namespace

std::vector<std::string> doubts_about_depth(const Frame& frame, double depth_scale, const std::string& path) {
  std::vector<std::string> doubts;
  if (!sees_something(frame)) return doubts;
  for (auto& doubt :
       {doubt_about_unit(depths_of(frame), depth_scale, path), doubt_about_density(frame, path)})
    if (!doubt.empty()) doubts.push_back(doubt);
  return doubts;
}

}  // namespace pliant
