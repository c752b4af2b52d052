#pragma once

#include <string>

#include "framework/geometry/animation.h"
#include "framework/geometry/mesh.h"

namespace pliant {

// All write the vertices at rest and the triangles of a mesh, and throw DataError naming the file when it
// cannot be written.

/// A binary little-endian PLY file, mm, in the mesh's own frame.
void write_mesh_ply(const std::string& path, const Mesh& mesh);

/// A binary glTF 2.0 file. glTF is in metres with y up and z towards who looks: the mesh's frame is taken for
/// a camera's (x right, y down, z forward), and its node turns and scales it.
void write_glb(const std::string& path, const Mesh& mesh);

/// The same with the mesh's morph targets and an animation of their weights, a linear track as wide as there
/// are targets. Throws std::invalid_argument for any other.
void write_animated_glb(const std::string& path, const Mesh& mesh, const Track& weights);

}  // namespace pliant
