#pragma once

#include <cstddef>
#include <vector>

#include "framework/geometry/image.h"
#include "framework/io/gltf_document.h"

namespace pliant {

/// The colours (sRGB) of the `count` vertices of a primitive: the base colour factor of its material times
/// the vertices' own (COLOR_0), both linear in the file; opacity and textures play no part. Empty where it
/// has neither. Throws DataError naming the file and what is wrong.
std::vector<Rgb> read_vertex_colors(const GltfDocument& document, const GltfDocument::Json& primitive,
                                    std::size_t count);

}  // namespace pliant
