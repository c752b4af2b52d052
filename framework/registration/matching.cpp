#include "framework/registration/projection.h"

#include <cmath>

#include "framework/device/lanes.h"
#include "framework/registration/point_map.cl.embed.h"
#include "framework/registration/projection.cl.embed.h"

namespace pliant {

std::string with_point_map(std::string_view source) {
  return with_lanes(std::string(embedded::framework_registration_point_map_cl).append(source));
}

cl::Kernel projection_kernel(Device& device, const std::string& name) {
  static const std::string source = with_point_map(embedded::framework_registration_projection_cl);
  return device.kernel(source, name);
}

cl_float4 pinhole(const Camera& camera) {
  return {{static_cast<float>(camera.fx), static_cast<float>(camera.fy), static_cast<float>(camera.cx),
           static_cast<float>(camera.cy)}};
}

cl_int2 image_size(const Camera& camera) { return {{camera.width, camera.height}}; }

Eigen::Vector3f finite_or_none(const Array<float>& vectors, std::size_t index) {
  const Eigen::Map<const Eigen::Vector3f> vector(vectors.host().data() + 3 * index);
  return (vector.array().abs() < farthest_depth).all() ? Eigen::Vector3f(vector) : Eigen::Vector3f::Zero();
}

std::optional<std::size_t> target_pixel_reference(const Target& target, const Eigen::Vector3f& point) {
  if (!(point.z() > 0)) return std::nullopt;
  const cl_float4 camera = pinhole(target.camera);
  const float u = std::floor(camera.s[0] * point.x() / point.z() + (camera.s[2] + 0.5F));
  const float v = std::floor(camera.s[1] * point.y() / point.z() + (camera.s[3] + 0.5F));
  const bool is_inside = u >= 0 && v >= 0 && u < static_cast<float>(target.camera.width) &&
                         v < static_cast<float>(target.camera.height);
  if (!is_inside) return std::nullopt;
  const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(target.camera.width) +
                     static_cast<std::size_t>(u);
  if (!(finite_or_none(target.points, pixel).z() > 0)) return std::nullopt;
  return pixel;
}

}  // namespace pliant
