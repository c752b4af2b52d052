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

/// Holds a camera, whose numbers stand at `place`, as "FILE:LINE", to what can belong to images of its size.
/// Throws DataError, which begins with the place, when its numbers cannot: normalised or in mm, focal lengths
/// and principal point swapped, made for images of another size.
Intrinsics check_intrinsics(const Camera& camera, const std::string& place);

/// Reads a 3x3 or 4x4 camera matrix (numbers between white space, row by row, pixels) for images of
/// width x height pixels; a byte-order mark before it is skipped. Throws DataError naming the file, and the
/// line, when it is not such a matrix, when it has skew or lens terms that a pinhole camera has not, or when
/// check_intrinsics does.
Intrinsics read_intrinsics(const std::string& path, int width, int height);

}  // namespace pliant
