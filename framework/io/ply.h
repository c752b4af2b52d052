#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/geometry/surface.h"

namespace pliant {

/// What is written of a surface. All lists but `triangles` have one entry a point.
struct PlySurface {
  Surface surface;                              ///< without colours the vertices are a neutral grey
  std::vector<float> errors;                    ///< mm, whatever the caller measured
  std::vector<Eigen::Vector3i> triangles = {};  ///< indices of points; may be empty
};

/// Makes or replaces a binary little-endian PLY file. Vertex properties in this order: `x y z nx ny nz`
/// (float, mm, camera frame), `u v` (int, the pixel), `error` (float, mm), `red green blue` (uchar).
/// Throws DataError naming the file when it cannot be written, std::invalid_argument when the lists
/// differ in length.
void write_ply(const std::string& path, const PlySurface& ply);

}  // namespace pliant
