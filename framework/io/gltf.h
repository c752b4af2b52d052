#pragma once

#include <string>

#include "framework/geometry/mesh.h"

namespace pliant {

/// Reads the mesh that the default scene of a binary glTF 2.0 file (.glb) makes up: all its nodes placed by
/// their transforms and all primitives together, metres made millimetres, in glTF's frame (x right and y up
/// for who looks along -z). The vertices are those of the file without any morph target; default weights in
/// the file play no part. Targets take their names from the mesh's `extras.targetNames`, else `target0`,
/// `target1`, ...; the same name in several meshes is one target.
///
/// Throws DataError naming the file and what is wrong with it. Not supported, and an error: data outside the
/// binary chunk, required extensions (such as Draco compression), skins, primitives that are not lists of
/// triangles.
Mesh read_gltf(const std::string& path);

}  // namespace pliant
