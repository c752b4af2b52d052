#pragma once

#include <string>

#include "framework/geometry/mesh.h"

namespace pliant {

inline constexpr double millimetres_per_metre = 1000;

/// Reads the mesh that the default scene of a binary glTF 2.0 file (.glb) makes up, or all its nodes where it
/// has no scene: all nodes placed by their transforms and all triangles, strips and fans together, in mm, in
/// glTF's frame (x right and y up for who looks along -z). A unit of the file has so many mm as `unit`:
/// glTF's is the metre, though not everybody's. Points and lines have no surface and are passed over. The
/// vertices are those of the file without any morph target; default weights in the file play no part. Targets
/// take their names from the mesh's `extras.targetNames`, else `target0`, `target1`, ...; the same name in
/// several meshes is one target.
///
/// Throws DataError naming the file and what is wrong with it. Not supported, and an error: data outside the
/// binary chunk, required extensions (such as Draco compression), skins.
Mesh read_gltf(const std::string& path, double unit = millimetres_per_metre);

}  // namespace pliant
