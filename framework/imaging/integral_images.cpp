#include "framework/imaging/integral_images.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "framework/imaging/depth_kernel.h"
#include "framework/imaging/integral_images.cl.embed.h"

namespace pliant {
namespace {

constexpr int most_rows = 48;      // of a tile
constexpr double steps = 1 << 28;  // of inverse depth, that of 1 mm: 1/8000 mm at 200 mm, 1/30 mm at 3 m

/// The most that inverse depth may come to where it is squared, so that squared differences over a window
/// have room in 32 bits.
float most_coarse(int radius, float depth_change) {
  const double pixels = (2 * radius + 1) * (2 * radius + 1);
  return static_cast<float>(std::sqrt(std::pow(2.0, 31) / pixels) / (radius * depth_change));
}

int most_columns(const Device& device) { return 10 * device.width(); }

int parts_of(int value, int divisor) { return (value + divisor - 1) / divisor; }

/// Tiles of equal size, so that all processors are done at once.
struct Tiling {
  int columns;  ///< of a tile, whole vectors
  int rows;
  std::size_t count;
};

Tiling tiling_of(const PixelWindow& window, const Device& device) {
  const int across = parts_of(window.width, most_columns(device));
  const int down = parts_of(window.height, most_rows);
  const int columns = parts_of(parts_of(window.width, across), device.width()) * device.width();
  const int rows = parts_of(window.height, down);
  return {columns, rows,
          static_cast<std::size_t>(parts_of(window.width, columns)) *
              static_cast<std::size_t>(parts_of(window.height, rows))};
}

/// Whether all pixels of a window have depth and none of them an edge to the next.
class Edges {
 public:
  Edges(const DepthImage& depth, float depth_change) : depth_(depth), change_(depth_change) {}

  bool has_none(int u, int v, int radius) const {
    for (int y = v - radius; y <= v + radius; ++y)
      for (int x = u - radius; x <= u + radius; ++x)
        if (is_edge(x, y)) return false;
    return true;
  }

 private:
  bool is_edge(int u, int v) const {
    const auto is_seen = [&](int x, int y) { return depth_.contains(x, y) && is_depth(depth_(x, y)); };
    if (!is_seen(u, v) || depth_(u, v) < IntegralImages::nearest_depth) return true;
    const float z = depth_(u, v);
    const auto jumps_to = [&](int x, int y) {
      return !is_seen(x, y) || std::abs(depth_(x, y) - z) > change_ * z;
    };
    return jumps_to(u + 1, v) || jumps_to(u, v + 1);
  }

  const DepthImage& depth_;
  float change_;
};

/// Covariance of the points of a window, weighted by 1 / z^2.
Eigen::Matrix3d covariance(const DepthImage& depth, const Camera& camera, int u, int v, int radius) {
  double weights = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int y = v - radius; y <= v + radius; ++y) {
    for (int x = u - radius; x <= u + radius; ++x) {
      const Eigen::Vector3d point = camera.unproject(x, y, depth(x, y));
      const double weight = 1 / (point.z() * point.z());
      weights += weight;
      sum += weight * point;
      squares += weight * point * point.transpose();
    }
  }
  return squares / weights - sum * sum.transpose() / (weights * weights);
}

}  // namespace

IntegralImages::IntegralImages(int radius, double depth_change)
    : radius_(radius), depth_change_(static_cast<float>(depth_change)) {}

void IntegralImages::write(Device& device, const DepthMap& map, SurfaceMap& surface) const {
  static const std::string source = with_plane(embedded::framework_imaging_integral_images_cl);
  const std::string options = fmt::format("{} -DTILE_COLUMNS={} -DNEAREST={:e}f -DSTEPS={:e}f",
                                          plane_options(), most_columns(device), nearest_depth, steps);
  auto kernel = device.kernel(source, "integral_images", options);
  const auto sums =
      static_cast<std::size_t>(5 * (2 * radius_ + 2) * (most_columns(device) + 2 * DepthMap::halo));
  const PixelWindow& window = map.window;
  if (window.size() == 0) return;
  const Tiling tiling = tiling_of(window, device);
  device.run("surface", kernel, tiling.count, 1, map.depth.device(device), static_cast<cl_int>(map.stride),
             cl_int2{{window.width, window.height}}, cl_int2{{window.left, window.top}},
             pinhole(surface.camera), cl_int2{{tiling.columns, tiling.rows}}, static_cast<cl_int>(radius_),
             depth_change_, most_coarse(radius_, depth_change_), cl::Local(sizeof(cl_int) * sums),
             surface.map.points.write_device(device), surface.map.normals.write_device(device));
}

Image<Eigen::Vector3f> IntegralImages::reference(const DepthImage& depth, const Camera& camera) const {
  const Edges edges(depth, depth_change_);
  Image<Eigen::Vector3f> normals(depth.width(), depth.height(), Eigen::Vector3f::Zero());
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      int radius = radius_;
      while (radius > 0 && !edges.has_none(u, v, radius)) --radius;
      if (radius == 0) continue;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance(depth, camera, u, v, radius));
      const Eigen::Vector3d least = solver.eigenvectors().col(0);
      const bool looks_away = least.dot(camera.unproject(u, v, 1)) > 0;
      normals(u, v) = (looks_away ? Eigen::Vector3d(-least) : least).cast<float>();
    }
  }
  return normals;
}

}  // namespace pliant
