#pragma once

#include <vector>

#include "framework/core/parameters.h"
#include "framework/geometry/camera.h"

namespace pliant {

/// A table of `rows`, followed by those of the camera that generated data is seen by.
ParameterTable with_camera(std::vector<Parameter> rows);

/// The camera that a section of such a table describes: 640x480 pixels at 525 pixels by default.
Camera virtual_camera(const Parameters& section);

}  // namespace pliant
