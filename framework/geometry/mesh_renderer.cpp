#include "framework/geometry/mesh_renderer.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "framework/device/lanes.h"
#include "framework/geometry/mesh_renderer.cl.embed.h"
#include "framework/geometry/mesh_view.cl.embed.h"
#include "framework/geometry/surface_map.h"

namespace pliant {
namespace {

constexpr const char* stage = "render";

std::vector<cl_int> corners_of(const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices) {
  std::vector<cl_int> corners;
  corners.reserve(3 * triangles.size());
  for (const Eigen::Vector3i& triangle : triangles) {
    for (const int vertex : triangle) {
      if (vertex < 0 || static_cast<std::size_t>(vertex) >= vertices)
        throw std::invalid_argument("a triangle names a vertex that does not exist");
      corners.push_back(vertex);
    }
  }
  return corners;
}

cl::Kernel drawing_kernel(Device& device, const char* name) {
  return device.kernel(embedded::framework_geometry_mesh_renderer_cl, name);
}

cl::Kernel view_kernel(Device& device, const char* name) {
  static const std::string source = with_lanes(embedded::framework_geometry_mesh_view_cl);
  static const std::string options =
      fmt::format("-DNEAREST_HIDING={:.9e}f -DHIDING_PIXELS={:.9e}f -DSTEEPEST_SLOPE={:.9e}f", nearest_hiding,
                  hiding_pixels, steepest_hiding_slope);
  return device.kernel(source, name, options);
}

cl_int2 size_of(const Camera& camera) { return {{camera.width, camera.height}}; }

std::size_t pixels_of(const Camera& camera) {
  return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
}

/// Work-items that take `device.width()` pixels of a row each.
std::size_t runs_of(const Device& device, const Camera& camera) {
  const int runs = (camera.width + device.width() - 1) / device.width();
  return static_cast<std::size_t>(runs) * static_cast<std::size_t>(camera.height);
}

/// Of the rows that a work-item draws: several bands for each of what works at a time, because some take
/// longer.
int rows_of_a_band(const Device& device, const Camera& camera) {
  const int bands = 8 * device.info().compute_units;
  return (camera.height + bands - 1) / bands;
}

template <class Pixel, class Value>
Image<Pixel> image_of(const Array<Value>& values, const Camera& camera) {
  Image<Pixel> image(camera.width, camera.height);
  values.copy_to(reinterpret_cast<Value*>(image.data()));
  return image;
}

}  // namespace

TrueMotion DeviceMotion::read(const Camera& camera) const {
  return {image_of<Eigen::Vector3f>(scene_flow, camera), image_of<Eigen::Vector2f>(optical_flow, camera),
          image_of<std::uint8_t>(visible, camera)};
}

MeshRenderer::MeshRenderer(Device& device, const std::vector<Eigen::Vector3i>& triangles,
                           std::size_t vertices)
    : device_(device), triangles_(corners_of(triangles, vertices)), vertices_(vertices) {
  if (triangles.empty()) throw std::invalid_argument("a mesh to be seen has a triangle");
}

void MeshRenderer::check(const Array<float>& values) const {
  if (values.size() != 3 * vertices_) throw std::invalid_argument("a mesh takes three numbers per vertex");
}

MeshView MeshRenderer::render(const Array<float>& vertices, const Camera& camera, float near) const {
  check(vertices);
  const std::size_t pixels = pixels_of(camera);
  const std::size_t count = triangles_.size() / 3;
  MeshView view{camera, Array<cl_int>(pixels), Array<float>(pixels), Array<float>(2 * pixels)};
  const Buffer places = device_.allocate(2 * sizeof(cl_int) * vertices_);
  const Buffer rows = device_.allocate(2 * sizeof(cl_int) * count);
  const Buffer& seen = view.triangles.write_device(device_);
  const Buffer& depth = view.depth.write_device(device_);
  auto place = drawing_kernel(device_, "place");
  auto reach = drawing_kernel(device_, "reach");
  auto draw = drawing_kernel(device_, "draw");
  auto locate = view_kernel(device_, "locate");
  device_.run(stage, place, vertices_, 64, vertices.device(device_), static_cast<cl_int>(vertices_),
              pinhole(camera), near, places);
  device_.run(stage, reach, count, 64, triangles_.device(device_), static_cast<cl_int>(count),
              vertices.device(device_), places, near, size_of(camera), rows);
  const int height = rows_of_a_band(device_, camera);
  device_.run(stage, draw, static_cast<std::size_t>((camera.height + height - 1) / height), 1,
              triangles_.device(device_), static_cast<cl_int>(count), vertices.device(device_), places, rows,
              pinhole(camera), near, size_of(camera), static_cast<cl_int>(height), depth, seen);
  device_.run(stage, locate, runs_of(device_, camera), 16, triangles_.device(device_),
              vertices.device(device_), pinhole(camera), size_of(camera), seen,
              view.shares.write_device(device_));
  return view;
}

Array<float> MeshRenderer::interpolate(const MeshView& view, const Array<float>& values) const {
  check(values);
  const std::size_t pixels = pixels_of(view.camera);
  Array<float> interpolated(3 * pixels);
  auto kernel = view_kernel(device_, "interpolate");
  device_.run(stage, kernel, runs_of(device_, view.camera), 16, triangles_.device(device_),
              values.device(device_), size_of(view.camera), view.triangles.device(device_),
              view.shares.device(device_), interpolated.write_device(device_));
  return interpolated;
}

DeviceMotion MeshRenderer::move(const MeshView& from, const Array<float>& to_vertices,
                                const MeshView& to) const {
  check(to_vertices);
  const std::size_t pixels = pixels_of(from.camera);
  DeviceMotion motion{Array<float>(3 * pixels), Array<float>(2 * pixels), Array<cl_uchar>(pixels)};
  auto kernel = view_kernel(device_, "move");
  device_.run(stage, kernel, runs_of(device_, from.camera), 16, triangles_.device(device_),
              size_of(from.camera), pinhole(from.camera), from.triangles.device(device_),
              from.shares.device(device_), from.depth.device(device_), to_vertices.device(device_),
              size_of(to.camera), pinhole(to.camera), to.depth.device(device_),
              motion.scene_flow.write_device(device_), motion.optical_flow.write_device(device_),
              motion.visible.write_device(device_));
  return motion;
}

}  // namespace pliant
