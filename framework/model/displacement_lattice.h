#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "framework/device/array.h"
#include "framework/model/tsdf_grid.h"

namespace pliant {

/// How a grid of voxels is displaced: known at the points of a coarser lattice, linear between them along
/// each axis. On one device.
class DisplacementLattice {
 public:
  /// Voxels from one point to the next. The first points lie at the first voxels, the last ones one voxel
  /// beyond the last.
  static constexpr int step = 4;

  explicit DisplacementLattice(const TsdfGrid& grid);

  const Eigen::Vector3i& size() const { return size_; }  ///< points along x, y, z

  /// Where the points are at rest: x y z each, mm, in the model's frame, in an order of their own: those that
  /// follow one another lie together. A few lie beyond the last ones and count for nothing. Only enqueues.
  Array<float> points_at_rest(Device& device) const;
  /// `moved`: where they are now, in the same order. Only enqueues. What follows asks for it.
  void displace(Device& device, const Array<float>& rest, const Array<float>& moved);

  /// Voxels: by how much the points are displaced along x, as many along y, as many along z.
  const Array<float>& displacements() const { return displacements_; }
  /// Voxels: of each brick the least displacement of a voxel along x, y, z, a zero, and the greatest
  /// likewise.
  const Array<float>& reaches() const { return reaches_; }

  /// Plain C++ reference of how kernels displace a voxel: where it is then, in voxels.
  Eigen::Vector3f displaced_reference(const Eigen::Vector3i& voxel) const;

 private:
  TsdfGrid grid_;
  Eigen::Vector3i size_;
  Array<float> displacements_, reaches_;
};

/// `source` behind what with_tsdf_grid() puts before it and lattice.cl, for tsdf_kernel().
std::string with_lattice(std::string_view source);

}  // namespace pliant
