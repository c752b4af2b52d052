#include "framework/imaging/depth_map.h"

#include <fmt/format.h>

#include <stdexcept>

#include "framework/device/lanes.h"
#include "framework/imaging/depth_kernel.h"
#include "framework/imaging/depth_map.cl.embed.h"

namespace pliant {
namespace {

constexpr std::size_t group = 64;

int round_up(int value, int step) { return (value + step - 1) / step * step; }

}  // namespace

cl::Kernel depth_kernel(Device& device, const std::string& name) {
  static const std::string source = with_lanes(embedded::framework_imaging_depth_map_cl);
  static const std::string options = fmt::format(
      "-DHALO={} -DNO_DEPTH={:e}f -DFEWEST_POINTS={} -DFLATTEST={:e}f -DWIDEST={} -DEDGE_ON={:e}f",
      DepthMap::halo, DepthMap::no_depth, fewest_plane_points, flattest_spread, widest_normal_radius,
      edge_on);
  return device.kernel(source, name, options);
}

DepthMap::DepthMap(int width, int height)
    : width(width),
      height(height),
      stride(round_up(width, halo) + 2 * halo),
      depth(static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows())) {}

DepthMap::DepthMap(const Frame& frame) : DepthMap(frame.depth.width(), frame.depth.height()) {
  if (!frame.mask.empty() && (frame.mask.width() != width || frame.mask.height() != height))
    throw std::invalid_argument("mask and depth differ in size");
  std::vector<float> values(depth.size(), no_depth);
  for (int v = 0; v < height; ++v) {
    float* row = values.data() + offset(0, v);
    const float* given = frame.depth.data() + static_cast<std::size_t>(v) * width;
    for (int u = 0; u < width; ++u) row[u] = is_depth(given[u]) ? given[u] : no_depth;
    if (frame.mask.empty()) continue;
    const std::uint8_t* mask = frame.mask.data() + static_cast<std::size_t>(v) * width;
    for (int u = 0; u < width; ++u) row[u] = mask[u] != 0 ? row[u] : no_depth;
  }
  depth = Array<float>(std::move(values));
}

DepthImage to_image(const DepthMap& map) {
  DepthImage image(map.width, map.height);
  for (int v = 0; v < map.height; ++v) {
    for (int u = 0; u < map.width; ++u) {
      const float depth = map.depth.host()[map.offset(u, v)];
      if (depth < DepthMap::no_depth) image(u, v) = depth;
    }
  }
  return image;
}

std::vector<int> pixels_with_depth(const DepthMap& map) {
  std::vector<int> pixels(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  std::size_t count = 0;
  for (int v = 0; v < map.height; ++v) {
    const float* row = map.depth.host().data() + map.offset(0, v);
    for (int u = 0; u < map.width; ++u) {
      // Written always and kept only where there is depth: no branch to mispredict.
      pixels[count] = v * map.width + u;
      count += row[u] < DepthMap::no_depth ? 1 : 0;
    }
  }
  pixels.resize(count);
  return pixels;
}

PointSet make_surface_map(Device& device, const DepthMap& map, const Camera& camera, int radius,
                          float depth_step) {
  const auto pixels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height);
  PointSet surface{Array<float>(3 * pixels), Array<float>(3 * pixels)};
  const int vectors = round_up(map.width, device.width()) / device.width();
  const cl_float4 pinhole = {{static_cast<float>(camera.fx), static_cast<float>(camera.fy),
                              static_cast<float>(camera.cx), static_cast<float>(camera.cy)}};
  auto kernel = depth_kernel(device, "surface");
  device.run("surface", kernel, static_cast<std::size_t>(vectors) * static_cast<std::size_t>(map.height),
             group, map.depth.device(device), static_cast<cl_int>(map.stride),
             cl_int2{{map.width, map.height}}, pinhole, static_cast<cl_int>(radius), depth_step,
             surface.points.write_device(device), surface.normals.write_device(device));
  return surface;
}

SurfaceImage make_surface_image(Device& device, const Frame& frame, const Camera& camera) {
  const PointSet map = make_surface_map(device, DepthMap(frame), camera);
  const Image<Eigen::Vector3f> none(frame.depth.width(), frame.depth.height(), Eigen::Vector3f::Zero());
  SurfaceImage image{none, none};
  if (map.points.empty()) return image;
  map.points.copy_to(image.points(0, 0).data());
  map.normals.copy_to(image.normals(0, 0).data());
  return image;
}

}  // namespace pliant
