#include "framework/imaging/plane_fit.h"

#include <fmt/format.h>

#include "framework/imaging/depth_kernel.h"
#include "framework/imaging/plane_fit.cl.embed.h"

namespace pliant {

PlaneFit::PlaneFit(int radius, float depth_step) : radius_(radius), depth_step_(depth_step) {}

void PlaneFit::write(Device& device, const DepthMap& map, SurfaceMap& surface) const {
  static const std::string source = with_plane(embedded::framework_imaging_plane_fit_cl);
  static const std::string options =
      fmt::format("{} -DFEWEST_POINTS={} -DWIDEST={} -DEDGE_ON={:e}f", plane_options(), fewest_plane_points,
                  widest_normal_radius, edge_on);
  auto kernel = device.kernel(source, "surface", options);
  const PixelWindow& window = map.window;
  device.run("surface", kernel, row_vectors(device, window), 64, map.depth.device(device),
             static_cast<cl_int>(map.stride), cl_int2{{window.width, window.height}},
             cl_int2{{window.left, window.top}}, pinhole(surface.camera), static_cast<cl_int>(radius_),
             depth_step_, surface.map.points.write_device(device), surface.map.normals.write_device(device));
}

}  // namespace pliant
