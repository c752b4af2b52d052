#include "framework/geometry/point_set.h"

#include "framework/geometry/point_set.cl.embed.h"

namespace pliant {
namespace {

cl_float4 row_of(const Eigen::Isometry3d& motion, int row) {
  const Eigen::Vector4f values = motion.matrix().row(row).cast<float>();
  return {{values[0], values[1], values[2], values[3]}};
}

}  // namespace

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "vectors lie next to each other without gaps");

Array<float> flatten(const std::vector<Eigen::Vector3f>& vectors) {
  if (vectors.empty()) return {};
  const float* values = vectors.front().data();
  return Array<float>(std::vector<float>(values, values + 3 * vectors.size()));
}

Array<float> flatten(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<float> values;
  values.reserve(3 * vectors.size());
  for (const Eigen::Vector3d& vector : vectors)
    for (const double value : vector) values.push_back(static_cast<float>(value));
  return Array<float>(std::move(values));
}

std::vector<Eigen::Vector3f> unflatten(const Array<float>& values) {
  std::vector<Eigen::Vector3f> vectors(values.size() / 3);
  if (!vectors.empty()) values.copy_to(vectors.front().data());
  return vectors;
}

PointSet pick_points(Device& device, const PointSet& set, const Array<int>& indices,
                     const Eigen::Isometry3d& motion) {
  PointSet picked{Array<float>(3 * indices.size()), Array<float>(3 * indices.size())};
  auto kernel = device.kernel(embedded::framework_geometry_point_set_cl, "pick");
  device.run("surface", kernel, indices.size(), 64, static_cast<cl_int>(indices.size()),
             indices.device(device), set.points.device(device), set.normals.device(device), row_of(motion, 0),
             row_of(motion, 1), row_of(motion, 2), picked.points.write_device(device),
             picked.normals.write_device(device));
  return picked;
}

}  // namespace pliant
