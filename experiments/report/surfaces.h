#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/surface.h"

namespace pliant {

/// Triangles between neighbouring pixels of a surface, as indices of its points, turned towards the
/// camera. None spans a depth step of more than `depth_step` mm: across it there is air.
std::vector<Eigen::Vector3i> triangulate(const Surface& surface, float depth_step);

}  // namespace pliant
