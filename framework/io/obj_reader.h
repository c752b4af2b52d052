#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/io/surface_mesh.h"

namespace pliant {

/// Reads a Wavefront OBJ file: vertices (`v x y z`, also with a weight, which must be 1, or with a colour of
/// three numbers from 0 to 1 behind) and faces (`f`, corners as `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted
/// from 1 or, negative, back from the last vertex so far). Lines of other kinds that there are, such as
/// groups, materials and lines, are passed over; free-form surfaces are an error. A unit of the file is so
/// many mm as `unit`. Throws DataError naming `path` and the line that is wrong.
SurfaceMesh read_obj(const std::vector<std::uint8_t>& bytes, const std::string& path, double unit);

}  // namespace pliant
