#include "framework/tracking/tracking_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "framework/core/angle.h"
#include "framework/tracking/tracking_error.cl.embed.h"

namespace pliant {
namespace {

constexpr std::size_t work_group = 64;

cl::Kernel error_kernel(Device& device, const std::string& name) {
  return device.kernel(embedded::framework_tracking_tracking_error_cl, name);
}

}  // namespace

ParameterTable tracking_error_table() {
  const TrackingErrorOptions defaults;
  return {real("max_distance", defaults.max_distance)
              .unit("mm")
              .above(0)
              .doc("What is further apart in depth does not belong together, and does not count"),
          real("max_view_angle", whole_degrees(defaults.max_view_angle))
              .unit("degree")
              .range(0, 90)
              .doc("Points of the model that turn further away from the camera do not count"),
          integer("radius", defaults.radius)
              .unit("pixel")
              .range(0, 64)
              .doc("The mean difference over so many pixels to each side counts: noise is averaged out"),
          real("min_gain", defaults.min_gain)
              .range(0, 1)
              .doc("Share by which the error must fall for a non-rigid registration to be kept")};
}

TrackingErrorOptions read_tracking_error(const Parameters& section) {
  return {section.real("max_distance"), section.real("max_view_angle") * degree,
          static_cast<int>(section.integer("radius")), section.real("min_gain")};
}

TrackingErrorMeter::TrackingErrorMeter(Device& device, const TrackingErrorOptions& options)
    : device_(device), options_(options) {}

TrackingError TrackingErrorMeter::measure(const SurfaceMap& model, const SurfaceMap& seen) {
  const std::size_t pixels = model.window.size();
  if (distances_.size() != pixels) {
    differences_ = Array<float>(pixels);
    sums_ = Array<float>(2 * pixels);
    distances_ = Array<float>(pixels);
    sum_.emplace(device_, pixels, options_.max_distance);
  }
  auto difference = error_kernel(device_, "difference");
  auto sum_rows = error_kernel(device_, "sum_rows");
  auto average = error_kernel(device_, "average");
  const PixelWindow& window = seen.window;
  const cl_int2 size{{model.window.width, model.window.height}};
  const cl_int radius = options_.radius;
  device_.run("error", difference, pixels, work_group, static_cast<cl_int>(pixels),
              model.points().device(device_), model.normals().device(device_), pinhole(seen.camera),
              cl_int4{{window.left, window.top, window.width, window.height}}, seen.points().device(device_),
              seen.normals().device(device_), static_cast<float>(options_.max_distance),
              static_cast<float>(std::cos(options_.max_view_angle)), differences_.write_device(device_));
  device_.run("error", sum_rows, pixels, work_group, size, radius, differences_.device(device_),
              sums_.write_device(device_));
  device_.run("error", average, pixels, work_group, size, radius, differences_.device(device_),
              sums_.device(device_), distances_.write_device(device_));
  sum_->add_up(distances_, model.map, seen);
  const Residual residual = sum_->read();
  return {residual.mean, residual.deviation, residual.matched};
}

std::vector<float> tracking_error_reference(const SurfaceMap& model, const SurfaceMap& seen,
                                            const TrackingErrorOptions& options) {
  const PixelWindow& window = model.window;
  const auto difference_at = [&](int column, int row) {
    const auto at = static_cast<std::size_t>(row * window.width + column);
    const Eigen::Map<const Eigen::Vector3f> p(model.points().host().data() + 3 * at);
    const Eigen::Map<const Eigen::Vector3f> n(model.normals().host().data() + 3 * at);
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    const auto least_facing = static_cast<float>(std::cos(options.max_view_angle));
    const auto faces_camera = [&](const Eigen::Vector3f& normal) {
      return -p.dot(normal) >= least_facing * p.norm();
    };
    if (!(p.z() > 0) || !faces_camera(n)) return unknown;
    const Eigen::Vector2d place = seen.camera.project(p.cast<double>());
    const Eigen::Vector2i pixel(static_cast<int>(std::nearbyint(place.x())),
                                static_cast<int>(std::nearbyint(place.y())));
    const Eigen::Vector3f q = finite_or_none(seen, seen.points(), pixel);
    const Eigen::Vector3f plane = finite_or_none(seen, seen.normals(), pixel);
    const float depth = faces_camera(plane) ? p.z() * plane.dot(q) / plane.dot(p) : q.z();
    const bool is_known = q.z() > 0 && std::abs(depth - p.z()) <= static_cast<float>(options.max_distance);
    return is_known ? depth - p.z() : unknown;
  };
  std::vector<float> distances;
  for (int row = 0; row < window.height; ++row) {
    for (int column = 0; column < window.width; ++column) {
      float sum = 0;
      int known = 0;
      for (int r = std::max(row - options.radius, 0); r <= std::min(row + options.radius, window.height - 1);
           ++r) {
        for (int c = std::max(column - options.radius, 0);
             c <= std::min(column + options.radius, window.width - 1); ++c) {
          const float difference = difference_at(c, r);
          if (std::isnan(difference)) continue;
          sum += difference;
          ++known;
        }
      }
      distances.push_back(std::isnan(difference_at(column, row)) ? -1
                                                                 : std::abs(sum / static_cast<float>(known)));
    }
  }
  return distances;
}

}  // namespace pliant
