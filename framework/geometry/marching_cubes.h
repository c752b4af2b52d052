#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>

#include "framework/geometry/mesh.h"

namespace pliant {

/// Where the samples of a regular grid are.
struct SampleGrid {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();    ///< samples along x, y, z
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< mm, of sample (0, 0, 0)
  double spacing = 1;                                ///< mm between neighbouring samples
};

/// Writes the signed distances (mm, negative inside) of the samples of a layer z = k: (i, j) at i + size.x j.
using DistanceLayers = std::function<void(int k, std::span<float> values)>;

/// A view of signed distances that are sampled on a regular grid, negative inside.
struct DistanceGrid : SampleGrid {
  std::span<const float> values;  ///< mm; (i, j, k) is at i + size.x (j + size.y k)
};

/// The surface of distance 0 as triangles with shared vertices, counter-clockwise from outside (where
/// distances are positive). It passes every sample on the side that its sign says, a zero counts as outside.
/// The surface is a manifold: each edge has two triangles, which run along it in opposite directions, but
/// where the surface leaves the grid; and where it meets a cell with a sample that is not finite, which is
/// left out because nothing is known there. Throws std::invalid_argument when the values do not fit the
/// size.
///
/// After Lorensen and Cline, "Marching cubes: a high resolution 3D surface construction algorithm",
/// SIGGRAPH 1987. Where the samples of a cell's face leave open how the surface runs (two inside, two
/// outside, across), those inside are kept apart. As that is seen from both cells alike there are no holes.
Mesh marching_cubes(const DistanceGrid& grid);

/// The same of samples that are asked for layer by layer, each once, so that only two need room.
Mesh marching_cubes(const SampleGrid& grid, const DistanceLayers& layers);

}  // namespace pliant
