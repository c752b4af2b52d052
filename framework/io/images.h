#pragma once

#include <string>

#include "framework/geometry/image.h"

namespace pliant {

// Every function throws DataError with a line that names the file and what is wrong with it.

/// Depth, as it is counted in the file, from a 16-bit single-channel PNG; 0 where there is none.
DepthImage read_depth(const std::string& path);

/// Colour from a PNG or JPEG, pixels as they are stored (an orientation tag is not followed, because
/// the image belongs to a depth image pixel by pixel).
ColorImage read_color(const std::string& path);

/// A mask from a PNG of any kind: 1 where a colour (of a palette, too) is not black and, where the file has
/// transparency, not fully transparent; else 0.
MaskImage read_mask(const std::string& path);

/// 16-bit PNG of whole millimetres, rounded; 0 where the depth is not finite or not positive.
/// A depth that 16 bits cannot hold is an error.
void write_depth(const std::string& path, const DepthImage& depth);

/// 8-bit RGB PNG.
void write_color(const std::string& path, const ColorImage& color);

/// 8-bit PNG, 255 on the object and 0 elsewhere.
void write_mask(const std::string& path, const MaskImage& mask);

}  // namespace pliant
