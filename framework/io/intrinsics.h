#pragma once

#include <string>
#include <vector>

#include "framework/geometry/camera.h"

namespace pliant {

struct Intrinsics {
  Camera camera;
  /// What is odd about them, a line each that names the file and the row's line: a principal point outside
  /// the image or far from its middle, as only images that were cut out of others have it.
  std::vector<std::string> warnings;
};

/// Reads a 3x3 or 4x4 camera matrix (numbers between white space, row by row, pixels) for images of
/// width x height pixels; a byte-order mark before it is skipped. Throws DataError naming the file, and the
/// line, when it is not such a matrix, when it has skew or lens terms that a pinhole camera has not, or when
/// its numbers cannot belong to such images: normalised or in mm, focal lengths and principal point swapped,
/// made for images of another size.
Intrinsics read_intrinsics(const std::string& path, int width, int height);

}  // namespace pliant
