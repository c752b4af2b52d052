#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/geometry/surface.h"

namespace pliant {

/// What is written of a surface. All lists but `triangles` have one entry a point.
struct PlySurface {
  Surface surface;                              ///< without colours the vertices are a neutral grey
  std::vector<float> errors;                    ///< mm, whatever the caller measured
  std::vector<Eigen::Vector3i> triangles = {};  ///< indices of points; may be empty
  std::vector<std::uint8_t> matched = {};  ///< whether a point has a match; empty where nothing is matched
};

/// Makes or replaces a binary little-endian PLY file. Vertex properties in this order: `x y z nx ny nz`
/// (float, mm, camera frame), `u v` (int, the pixel), `error` (float, mm), `red green blue` (uchar) and,
/// where matches are told, `matched` (uchar, 0 or 1). Throws DataError naming the file when it cannot be
/// written, std::invalid_argument when the lists differ in length.
void write_ply(const std::string& path, const PlySurface& ply);

}  // namespace pliant
