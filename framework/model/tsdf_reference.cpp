#include "framework/model/tsdf_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace pliant {
namespace {

/// What a map shows between four pixels at a place in the image: see depth_at() of tsdf_fuse.cl.
std::optional<float> depth_at(const DepthMap& map, float u, float v, float truncation) {
  const float left = std::floor(u);
  const float top = std::floor(v);
  const float a = u - left;
  const float b = v - top;
  const float column = left + (a >= 0.5F ? 1.0F : 0.0F);
  const float row = top + (b >= 0.5F ? 1.0F : 0.0F);
  constexpr float widest = 1e6F;  // beyond any image, and whole
  if (!(std::abs(u) < widest && std::abs(v) < widest)) return std::nullopt;
  if (!map.window.contains(static_cast<int>(column), static_cast<int>(row))) return std::nullopt;
  const float* corner = map.depth.host().data() + map.offset(static_cast<int>(left) - map.window.left,
                                                             static_cast<int>(top) - map.window.top);
  const float nearest = corner[(a >= 0.5F ? 1 : 0) + (b >= 0.5F ? map.stride : 0)];
  if (!(nearest < DepthMap::no_depth)) return std::nullopt;
  const auto near = [&](int offset) {
    return std::abs(corner[offset] - nearest) < truncation ? corner[offset] : nearest;
  };
  const float upper = std::fma(a, near(1) - near(0), near(0));
  const float lower = std::fma(a, near(map.stride + 1) - near(map.stride), near(map.stride));
  return std::fma(b, lower - upper, upper);
}

/// So many more frames tell that the surface lies `ahead` mm before a voxel.
void average(float ahead, float truncation, float shown, float max_weight, std::int16_t& distance,
             std::uint8_t& weight) {
  const auto known = static_cast<float>(weight);
  const float told = std::min(ahead, truncation) * (static_cast<float>(TsdfGrid::steps) / truncation);
  const float mean =
      std::nearbyint(std::fma(static_cast<float>(distance), known, told * shown) / (known + shown));
  distance = static_cast<std::int16_t>(mean == 0 ? 1 : mean);
  weight = static_cast<std::uint8_t>(std::min(known + shown, max_weight));
}

/// `placed`: where a voxel lies, in voxels.
template <class Placed>
void fuse_voxels(const TsdfGrid& grid, int max_weight, const DepthMap& depth, const Camera& camera,
                 const Eigen::Isometry3d& camera_from_model, TsdfVoxels& voxels, int weight,
                 const Placed& placed) {
  const cl_float16 rows = rows_of(camera_from_model * grid.model_from_voxel());
  const cl_float4 pixels = pinhole(camera);
  const auto truncation = static_cast<float>(grid.truncation);
  std::size_t at = 0;
  for (int k = 0; k < grid.size.z(); ++k) {
    for (int j = 0; j < grid.size.y(); ++j) {
      for (int i = 0; i < grid.size.x(); ++i, ++at) {
        const Eigen::Vector3f p = placed(Eigen::Vector3i(i, j, k));
        const auto along = [&](int row) {
          const cl_float* m = rows.s + 4 * row;
          return std::fma(m[0], p.x(), std::fma(m[1], p.y(), std::fma(m[2], p.z(), m[3])));
        };
        const float z = along(2);
        if (!(z > 0)) continue;
        const float inverse = 1 / z;
        const float u = std::fma(pixels.s[0], along(0) * inverse, pixels.s[2]);
        const float v = std::fma(pixels.s[1], along(1) * inverse, pixels.s[3]);
        const auto seen = depth_at(depth, u, v, truncation);
        if (!seen) continue;
        const float ahead = *seen - z;
        const bool is_told = ahead >= -truncation && (voxels.distances[at] != 0 || ahead < truncation);
        if (is_told)
          average(ahead, truncation, static_cast<float>(weight), static_cast<float>(max_weight),
                  voxels.distances[at], voxels.weights[at]);
      }
    }
  }
}

/// The field of distances on a grid, as rays through it see it.
class Field {
 public:
  Field(const TsdfGrid& grid, const TsdfVoxels& voxels) : grid_(grid), voxels_(voxels) {}

  /// In parts of the truncation; 0 where nothing was observed, and outside.
  double at(const Eigen::Vector3i& voxel) const {
    const bool is_inside = (voxel.array() >= 0).all() && (voxel.array() < grid_.size.array()).all();
    if (!is_inside) return 0;
    const Eigen::Matrix<std::size_t, 3, 1> v = voxel.cast<std::size_t>();
    const Eigen::Matrix<std::size_t, 3, 1> size = grid_.size.cast<std::size_t>();
    return voxels_.distances[v.x() + size.x() * (v.y() + size.y() * v.z())];
  }

  double nearest(const Eigen::Vector3d& p) const {
    return at((p.array() + 0.5).floor().matrix().cast<int>());
  }

  /// Between the eight voxels around; none unless all of them were observed and are not at the grid's border.
  std::optional<double> between(const Eigen::Vector3d& p) const {
    const Eigen::Vector3i corner = p.array().floor().matrix().cast<int>();
    const bool is_inside = (corner.array() >= 1).all() && (corner.array() < grid_.size.array() - 2).all();
    return is_inside ? interpolated(p) : std::nullopt;
  }

  /// By central differences of what is between the voxels; where one of those was not observed, that of the
  /// cell.
  Eigen::Vector3d gradient(const Eigen::Vector3d& p) const {
    Eigen::Vector3d smooth;
    for (int axis = 0; axis < 3; ++axis) {
      const auto behind = interpolated(p + Eigen::Vector3d::Unit(axis));
      const auto before = interpolated(p - Eigen::Vector3d::Unit(axis));
      if (!behind || !before) return gradient_of_cell(p);
      smooth[axis] = (*behind - *before) / 2;
    }
    return smooth;
  }

 private:
  std::optional<double> interpolated(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d floor = p.array().floor();
    const Eigen::Vector3d share = p - floor;
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3i bits(corner & 1, corner >> 1 & 1, corner >> 2);
      const double value = at(floor.cast<int>() + bits);
      if (value == 0) return std::nullopt;
      double weight = 1;
      for (int axis = 0; axis < 3; ++axis) weight *= bits[axis] == 1 ? share[axis] : 1 - share[axis];
      sum += weight * value;
    }
    return sum;
  }

  /// The interpolant is linear along each axis.
  Eigen::Vector3d gradient_of_cell(const Eigen::Vector3d& p) const {
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Vector3d before = p;
      Eigen::Vector3d behind = p;
      before[axis] = std::floor(p[axis]);
      behind[axis] = before[axis] + 1 - 1e-9;
      gradient[axis] = interpolated(behind).value_or(0) - interpolated(before).value_or(0);
    }
    return gradient;
  }

  const TsdfGrid& grid_;
  const TsdfVoxels& voxels_;
};

struct Ray {
  Eigen::Vector3d from, direction;  ///< voxels; the direction a mm along the camera's axis

  Eigen::Vector3d at(double z) const { return from + z * direction; }
};

/// The depths between which all of the grid lies.
std::array<double, 2> depths_of(const TsdfGrid& grid, const Eigen::Affine3d& camera_from_voxel) {
  std::array<double, 2> depths{std::numeric_limits<double>::max(), 0};
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d bits(corner & 1, corner >> 1 & 1, corner >> 2);
    const double z = (camera_from_voxel * bits.cwiseProduct(grid.size.cast<double>())).z();
    depths = {std::min(depths[0], z), std::max(depths[1], z)};
  }
  return {std::max(depths[0], 0.0), depths[1]};
}

/// Where the ray first passes from before the surface to behind it, by halving.
std::optional<double> crossing(const Field& field, const Ray& ray, std::array<double, 2> depths,
                               double step) {
  double last = 0;
  for (double z = depths[0]; z <= depths[1]; z += step) {
    const double value = field.nearest(ray.at(z));
    if (last < 0 && value > 0) return std::nullopt;
    if (last > 0 && value < 0) {
      double before = z - 2 * step;
      double behind = z + step;
      for (int round = 0; round < 40; ++round) {
        const double middle = (before + behind) / 2;
        const auto between = field.between(ray.at(middle));
        // Before the surface the field may be unknown a voxel farther out than at it.
        (between.value_or(middle < z - step / 2 ? 1 : -1) > 0 ? before : behind) = middle;
      }
      return field.between(ray.at(behind)) ? std::optional(behind) : std::nullopt;
    }
    last = value;
  }
  return std::nullopt;
}

}  // namespace

void integrate_reference(const TsdfGrid& grid, int max_weight, const DepthMap& depth, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_model, TsdfVoxels& voxels, int weight) {
  fuse_voxels(grid, max_weight, depth, camera, camera_from_model, voxels, weight,
              [](const Eigen::Vector3i& voxel) -> Eigen::Vector3f { return voxel.cast<float>(); });
}

void integrate_reference(const TsdfGrid& grid, int max_weight, const DepthMap& depth, const Camera& camera,
                         const Eigen::Isometry3d& camera_from_model, const DisplacementLattice& lattice,
                         TsdfVoxels& voxels) {
  fuse_voxels(grid, max_weight, depth, camera, camera_from_model, voxels, 1,
              [&](const Eigen::Vector3i& voxel) { return lattice.displaced_reference(voxel); });
}

SurfaceImage raycast_reference(const TsdfGrid& grid, const TsdfVoxels& voxels, const Camera& camera,
                               const Eigen::Isometry3d& camera_from_model) {
  const Eigen::Affine3d camera_from_voxel = camera_from_model * grid.model_from_voxel();
  const Eigen::Affine3d voxel_from_camera = camera_from_voxel.inverse();
  const Image<Eigen::Vector3f> none(camera.width, camera.height, Eigen::Vector3f::Zero());
  SurfaceImage seen{none, none};
  const Field field(grid, voxels);
  const auto depths = depths_of(grid, camera_from_voxel);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d direction = camera.unproject(u, v, 1);
      const Ray ray{voxel_from_camera.translation(), voxel_from_camera.linear() * direction};
      const auto z = crossing(field, ray, depths, grid.voxel / direction.norm());
      if (!z) continue;
      const Eigen::Vector3d normal = (camera_from_voxel.linear() * field.gradient(ray.at(*z))).normalized();
      if (!(normal.dot(direction) < 0)) continue;
      seen.points(u, v) = (*z * direction).cast<float>();
      seen.normals(u, v) = normal.cast<float>();
    }
  }
  return seen;
}

}  // namespace pliant
