#pragma once

#include <string>

#include "framework/geometry/camera.h"

namespace pliant {

/// Reads a 3x3 or 4x4 camera matrix (numbers between white space, row by row, pixels) for images of
/// width x height pixels. Throws DataError naming the file when it is not such a matrix, when it has
/// skew or lens terms that a pinhole camera has not, or when its principal point shows that it was made
/// for images of another size.
Camera read_intrinsics(const std::string& path, int width, int height);

}  // namespace pliant
