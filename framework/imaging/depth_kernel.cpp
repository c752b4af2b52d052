#include "framework/imaging/depth_kernel.h"

#include <fmt/format.h>

#include "framework/device/lanes.h"
#include "framework/geometry/surface.h"
#include "framework/imaging/depth_map.cl.embed.h"
#include "framework/imaging/depth_map.h"
#include "framework/imaging/plane.cl.embed.h"

namespace pliant {

std::string with_depth_map(std::string_view source) {
  return with_lanes(std::string(embedded::framework_imaging_depth_map_cl).append(source));
}

std::string depth_map_options() {
  return fmt::format("-DHALO={} -DNO_DEPTH={:e}f", DepthMap::halo, DepthMap::no_depth);
}

std::string with_plane(std::string_view source) {
  return with_depth_map(std::string(embedded::framework_imaging_plane_cl).append(source));
}

std::string plane_options() {
  return fmt::format("{} -DFLATTEST={:e}f", depth_map_options(), flattest_spread);
}

std::size_t row_vectors(const Device& device, const PixelWindow& window) {
  const int vectors = (window.width + device.width() - 1) / device.width();
  return static_cast<std::size_t>(vectors) * static_cast<std::size_t>(window.height);
}

}  // namespace pliant
