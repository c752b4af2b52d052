#pragma once

#include <cstddef>

#include "experiments/report/view_data.h"
#include "framework/geometry/mesh.h"

namespace pliant {

/// The mesh at rest with at most `most` > 0 vertices, for small pictures of it: where there are more, those
/// in a cube of a grid become one, and triangles that are left without extent go [Rossignac and Borrel,
/// Multi-resolution 3D approximations for rendering complex scenes, 1993].
ViewData::Mesh clustered_mesh(const Mesh& mesh, std::size_t most);

}  // namespace pliant
