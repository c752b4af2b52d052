#include "framework/geometry/point_set.h"

#include <string>

#include "framework/geometry/point_set.cl.embed.h"

namespace pliant {
namespace {

cl_float4 row_of(const Eigen::Isometry3d& motion, int row) {
  const Eigen::Vector4f values = motion.matrix().row(row).cast<float>();
  return {{values[0], values[1], values[2], values[3]}};
}

cl::Kernel point_kernel(Device& device, const std::string& name) {
  return device.kernel(embedded::framework_geometry_point_set_cl, name);
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
  auto kernel = point_kernel(device, "pick");
  device.run("surface", kernel, indices.size(), 64, static_cast<cl_int>(indices.size()),
             indices.device(device), set.points.device(device), set.normals.device(device), row_of(motion, 0),
             row_of(motion, 1), row_of(motion, 2), picked.points.write_device(device),
             picked.normals.write_device(device));
  return picked;
}

void place_points(Device& device, const PointSet& set, const Array<int>& indices, PointSet& into) {
  auto kernel = point_kernel(device, "place");
  device.run("surface", kernel, indices.size(), 64, static_cast<cl_int>(indices.size()),
             indices.device(device), set.points.device(device), set.normals.device(device),
             into.points.write_device(device), into.normals.write_device(device));
}

void move_points(Device& device, const PointSet& set, const Eigen::Isometry3d& motion, PointSet& into) {
  auto kernel = point_kernel(device, "move");
  const std::size_t count = set.points.size() / 3;
  device.run("surface", kernel, count, 64, static_cast<cl_int>(count), set.points.device(device),
             set.normals.device(device), row_of(motion, 0), row_of(motion, 1), row_of(motion, 2),
             into.points.write_device(device), into.normals.write_device(device));
}

PointSet no_points(Device& device, std::size_t count) {
  PointSet set{Array<float>(3 * count), Array<float>(3 * count)};
  device.fill_zero(set.points.write_device(device), 3 * count * sizeof(float));
  device.fill_zero(set.normals.write_device(device), 3 * count * sizeof(float));
  return set;
}

std::vector<int> indices_of_points(Device& device, const PointSet& set) {
  auto kernel = point_kernel(device, "find");
  const std::size_t count = set.points.size() / 3;
  Array<cl_uchar> found(count);
  device.run("surface", kernel, count, 64, static_cast<cl_int>(count), set.points.device(device),
             found.write_device(device));
  std::vector<int> indices;
  for (std::size_t i = 0; i < count; ++i)
    if (found.host()[i] != 0) indices.push_back(static_cast<int>(i));
  return indices;
}

}  // namespace pliant
