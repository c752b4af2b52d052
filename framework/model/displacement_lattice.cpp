#include "framework/model/displacement_lattice.h"

#include <fmt/format.h>

#include <cmath>

#include "framework/model/lattice.cl.embed.h"

namespace pliant {
namespace {

cl::Kernel lattice_kernel(Device& device, const std::string& name) {
  static const std::string source = with_lattice("");
  return tsdf_kernel(device, source, name);
}

/// Whole blocks of lattice.cl.
std::size_t listed_points(const Eigen::Vector3i& size) {
  const Eigen::Vector3i block(4, 2, 2);
  const Eigen::Vector3i blocks = ((size + block).array() - 1).matrix().cwiseQuotient(block);
  return (blocks.cwiseProduct(block)).cast<std::size_t>().prod();
}

}  // namespace

DisplacementLattice::DisplacementLattice(const TsdfGrid& grid)
    : grid_(grid),
      size_(grid.size / step + Eigen::Vector3i::Ones()),
      displacements_(3 * size_.cast<std::size_t>().prod()),
      reaches_(8 * grid.bricks().cast<std::size_t>().prod()) {}

Array<float> DisplacementLattice::points_at_rest(Device& device) const {
  auto place = lattice_kernel(device, "place_points");
  const std::size_t count = listed_points(size_);
  Array<float> points(3 * count);
  device.run("displace", place, count, 64, static_cast<cl_int>(count), bricks_of(grid_),
             rows_of(grid_.model_from_voxel()), points.write_device(device));
  return points;
}

void DisplacementLattice::displace(Device& device, const Array<float>& rest, const Array<float>& moved) {
  auto displace = lattice_kernel(device, "displace");
  auto bound = lattice_kernel(device, "bound_displacements");
  const std::size_t count = rest.size() / 3;
  const Buffer& displacements = displacements_.write_device(device);
  device.run("displace", displace, count, 64, static_cast<cl_int>(count), bricks_of(grid_),
             static_cast<float>(grid_.voxel), rest.device(device), moved.device(device), displacements);
  device.run("displace", bound, reaches_.size() / 8, 64, bricks_of(grid_), displacements,
             reaches_.write_device(device));
}

Eigen::Vector3f DisplacementLattice::displaced_reference(const Eigen::Vector3i& voxel) const {
  const Eigen::Vector3i corner = voxel / step;
  const Eigen::Vector3f share = (voxel - step * corner).cast<float>() / static_cast<float>(step);
  const auto row = static_cast<std::size_t>(size_.x());
  const std::size_t layer = row * static_cast<std::size_t>(size_.y());
  const std::size_t points = layer * static_cast<std::size_t>(size_.z());
  const auto mixed = [](float a, float b, float part) { return std::fma(part, b - a, a); };
  Eigen::Vector3f displaced = voxel.cast<float>();
  for (int axis = 0; axis < 3; ++axis) {
    const float* at = displacements_.host().data() + static_cast<std::size_t>(axis) * points +
                      static_cast<std::size_t>(corner.x()) + row * static_cast<std::size_t>(corner.y()) +
                      layer * static_cast<std::size_t>(corner.z());
    const auto between = [&](const float* p) {
      return mixed(mixed(p[0], p[row], share.y()), mixed(p[layer], p[layer + row], share.y()), share.z());
    };
    displaced[axis] += mixed(between(at), between(at + 1), share.x());
  }
  return displaced;
}

std::string with_lattice(std::string_view source) {
  return with_tsdf_grid(fmt::format("#define CELL {}\n{}{}", DisplacementLattice::step,
                                    embedded::framework_model_lattice_cl, source));
}

}  // namespace pliant
