#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/io/surface_mesh.h"

namespace pliant {

bool is_ply(const std::vector<std::uint8_t>& bytes);

/// Reads a PLY file (Turk, The PLY Polygon File Format, 1994), ascii or binary of either byte order: `x y z`
/// of the element `vertex`, which are numbers of any type, `red green blue` where all three are there (8-bit,
/// or floats from 0 to 1), and the lists `vertex_indices` or `vertex_index` of the element `face`. Properties
/// and elements may come in any order; all others are passed over. A unit of the file is so many mm as
/// `unit`. Throws DataError naming `path` and the line, or the element, that is wrong.
SurfaceMesh read_ply(const std::vector<std::uint8_t>& bytes, const std::string& path, double unit);

}  // namespace pliant
