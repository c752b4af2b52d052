#pragma once

#include <cstddef>

#include "framework/geometry/mesh.h"

namespace pliant::test {

/// How many pairs of triangles of the mesh at rest pass through each other. Of two that share corners the
/// edges without these count.
std::size_t count_intersections(const Mesh& mesh);

}  // namespace pliant::test
