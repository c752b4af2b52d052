#include "framework/imaging/cross_product.h"

#include <cmath>

#include "framework/imaging/cross_product.cl.embed.h"
#include "framework/imaging/depth_kernel.h"

namespace pliant {

CrossProduct::CrossProduct(int reach, double depth_change)
    : reach_(reach), depth_change_(static_cast<float>(depth_change)) {}

void CrossProduct::write(Device& device, const DepthMap& map, SurfaceMap& surface) const {
  static const std::string source = with_depth_map(embedded::framework_imaging_cross_product_cl);
  auto kernel = device.kernel(source, "cross_product", depth_map_options());
  const PixelWindow& window = map.window;
  device.run("surface", kernel, row_vectors(device, window), 64, map.depth.device(device),
             static_cast<cl_int>(map.stride), cl_int2{{window.width, window.height}},
             cl_int2{{window.left, window.top}}, pinhole(surface.camera), static_cast<cl_int>(reach_),
             depth_change_, surface.map.points.write_device(device),
             surface.map.normals.write_device(device));
}

Image<Eigen::Vector3f> CrossProduct::reference(const DepthImage& depth, const Camera& camera) const {
  Image<Eigen::Vector3f> normals(depth.width(), depth.height(), Eigen::Vector3f::Zero());
  const auto point = [&](int u, int v) { return camera.unproject(u, v, depth(u, v)); };
  const auto is_near = [&](int u, int v, float z) {
    return depth.contains(u, v) && is_depth(depth(u, v)) &&
           std::abs(depth(u, v) - z) <= static_cast<float>(reach_) * depth_change_ * z;
  };
  const auto difference = [&](int u, int v, int du, int dv) -> Eigen::Vector3d {
    const float z = depth(u, v);
    const Eigen::Vector3d from = is_near(u - du, v - dv, z) ? point(u - du, v - dv) : point(u, v);
    const Eigen::Vector3d to = is_near(u + du, v + dv, z) ? point(u + du, v + dv) : point(u, v);
    return to - from;
  };
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      if (!is_depth(depth(u, v))) continue;
      const Eigen::Vector3d normal = difference(u, v, 0, reach_).cross(difference(u, v, reach_, 0));
      if (normal.squaredNorm() > 0) normals(u, v) = normal.normalized().cast<float>();
    }
  }
  return normals;
}

}  // namespace pliant
