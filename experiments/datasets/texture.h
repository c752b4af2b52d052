#pragma once

#include <Eigen/Core>

#include "framework/geometry/image.h"

namespace pliant {

/// Colour of the material point whose coordinates at rest are `point` (mm): smooth random noise of several
/// scales, the same wherever the material goes, so that it can be found again in another image.
Rgb texture_color(const Eigen::Vector3d& point);

}  // namespace pliant
