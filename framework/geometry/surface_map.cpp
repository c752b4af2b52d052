#include "framework/geometry/surface_map.h"

#include <cmath>
#include <utility>

#include "framework/device/lanes.h"
#include "framework/geometry/surface_map.cl.embed.h"

namespace pliant {

SurfaceMap::SurfaceMap(const Camera& camera, const PixelWindow& window, PointSet map)
    : camera(camera), window(window), map(std::move(map)) {}

SurfaceMap::SurfaceMap(const Camera& camera, const SurfaceImage& image)
    : SurfaceMap(camera, whole_image(camera),
                 PointSet{flatten(image.points.pixels()), flatten(image.normals.pixels())}) {}

std::string with_surface_map(std::string_view source) {
  return with_lanes(std::string(embedded::framework_geometry_surface_map_cl).append(source));
}

cl_float4 pinhole(const Camera& camera) {
  return {{static_cast<float>(camera.fx), static_cast<float>(camera.fy), static_cast<float>(camera.cx),
           static_cast<float>(camera.cy)}};
}

cl_int8 frame_of(const SurfaceMap& map) {
  const PixelWindow& window = map.window;
  return {{window.left, window.top, window.width, window.height, map.camera.width, map.camera.height, 0, 0}};
}

Eigen::Vector3f finite_or_none(const Array<float>& vectors, std::size_t index) {
  const Eigen::Map<const Eigen::Vector3f> vector(vectors.host().data() + 3 * index);
  return (vector.array().abs() < farthest_depth).all() ? Eigen::Vector3f(vector) : Eigen::Vector3f::Zero();
}

Eigen::Vector3f finite_or_none(const SurfaceMap& map, const Array<float>& vectors,
                               const Eigen::Vector2i& pixel) {
  if (!map.window.contains(pixel.x(), pixel.y())) return Eigen::Vector3f::Zero();
  return finite_or_none(vectors, map.window.offset(pixel.x(), pixel.y()));
}

std::optional<Eigen::Vector3d> middle_of(const SurfaceMap& map) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t pixel = 0; pixel < map.window.size(); ++pixel) {
    const Eigen::Vector3f point = finite_or_none(map.points(), pixel);
    if (!(point.z() > 0)) continue;
    sum += point.cast<double>();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

std::optional<Eigen::Vector2i> pixel_reference(const Camera& camera, const Eigen::Vector3f& point) {
  if (!(point.z() > 0)) return std::nullopt;
  const cl_float4 values = pinhole(camera);
  const float u = std::floor(values.s[0] * point.x() / point.z() + (values.s[2] + 0.5F));
  const float v = std::floor(values.s[1] * point.y() / point.z() + (values.s[3] + 0.5F));
  const bool is_inside =
      u >= 0 && v >= 0 && u < static_cast<float>(camera.width) && v < static_cast<float>(camera.height);
  if (!is_inside) return std::nullopt;
  return Eigen::Vector2i(static_cast<int>(u), static_cast<int>(v));
}

std::optional<std::size_t> seen_pixel_reference(const SurfaceMap& map, const Eigen::Vector3f& point) {
  const auto pixel = pixel_reference(map.camera, point);
  if (!pixel || !(finite_or_none(map, map.points(), *pixel).z() > 0)) return std::nullopt;
  return map.window.offset(pixel->x(), pixel->y());
}

}  // namespace pliant
