#include "framework/deformation/warp.h"

#include <Eigen/Geometry>
#include <cmath>

#include "framework/deformation/warp.cl.embed.h"
#include "framework/device/lanes.h"

namespace pliant {

namespace {

const std::string& source() {
  static const std::string text = with_lanes(embedded::framework_deformation_warp_cl);
  return text;
}

/// What the nodes do to points, as make_rows of warp.cl has it.
Buffer rows_of_nodes(Device& device, const Array<float>& node_points, const Array<float>& affine) {
  const std::size_t count = node_points.size() / 3;
  Buffer rows = device.allocate(16 * sizeof(float) * count);
  auto make_rows = device.kernel(source(), "make_rows");
  device.run("warp", make_rows, count, 64, static_cast<cl_int>(count), node_points.device(device),
             affine.device(device), rows);
  return rows;
}

}  // namespace

void warp(Device& device, const PointSet& rest, const Influences& influences, const Array<float>& node_points,
          const Array<float>& affine, PointSet& moved) {
  const auto count = rest.points.size() / 3;
  const auto width = static_cast<std::size_t>(device.width());
  const Buffer rows = rows_of_nodes(device, node_points, affine);
  auto kernel = device.kernel(source(), "warp");
  device.run("warp", kernel, (count + width - 1) / width, 16, rest.points.device(device),
             rest.normals.device(device), static_cast<cl_int>(count), influences.nodes.device(device),
             influences.weights.device(device), static_cast<cl_int>(influences.per_point),
             node_points.device(device), rows, moved.points.write_device(device),
             moved.normals.write_device(device));
}

void warp_points(Device& device, const Array<float>& points, const Influences& influences,
                 const Array<float>& node_points, const Array<float>& affine, Array<float>& moved) {
  const auto count = points.size() / 3;
  const auto width = static_cast<std::size_t>(device.width());
  const Buffer rows = rows_of_nodes(device, node_points, affine);
  auto kernel = device.kernel(source(), "warp_points");
  device.run("warp", kernel, (count + width - 1) / width, 16, points.device(device),
             static_cast<cl_int>(count), influences.nodes.device(device), influences.weights.device(device),
             static_cast<cl_int>(influences.per_point), node_points.device(device), rows,
             moved.write_device(device));
}

PointSet warp_reference(const PointSet& rest, const Influences& influences, const Array<float>& node_points,
                        const Array<float>& affine) {
  using Points = Eigen::Map<const Eigen::Matrix3Xf>;
  const auto count = static_cast<Eigen::Index>(rest.points.size() / 3);
  const Points points(rest.points.host().data(), 3, count);
  const Points normals(rest.normals.host().data(), 3, count);
  const Points nodes(node_points.host().data(), 3, static_cast<Eigen::Index>(node_points.size() / 3));
  Eigen::Matrix3Xf moved = points;
  Eigen::Matrix3Xf turned = normals;
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Matrix3f blended = Eigen::Matrix3f::Identity();
    for (int slot = 0; slot < influences.per_point; ++slot) {
      const auto entry = static_cast<std::size_t>(i * influences.per_point + slot);
      const auto node = influences.nodes.host()[entry];
      const float weight = influences.weights.host()[entry];
      const Eigen::Map<const Eigen::Matrix<float, 3, 4>> form(affine.host().data() + affine_size * node);
      moved.col(i) += weight * (form.leftCols<3>() * (points.col(i) - nodes.col(node)) + form.col(3));
      blended += weight * form.leftCols<3>();
    }
    Eigen::Matrix3f cofactors;
    cofactors << blended.col(1).cross(blended.col(2)), blended.col(2).cross(blended.col(0)),
        blended.col(0).cross(blended.col(1));
    const Eigen::Vector3f direction = cofactors * normals.col(i);
    const bool can_turn = std::isfinite(direction.squaredNorm());
    turned.col(i) = can_turn ? direction.stableNormalized() : Eigen::Vector3f::Zero();
  }
  return {Array<float>(std::vector<float>(moved.data(), moved.data() + moved.size())),
          Array<float>(std::vector<float>(turned.data(), turned.data() + turned.size()))};
}

}  // namespace pliant
