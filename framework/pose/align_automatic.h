#pragma once

#include <Eigen/Geometry>

#include "framework/core/registry.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// How far the source lies from the target after a rigid motion: mean distance to the target point at the
/// pixel a source point projects to, over every fourth pixel in both directions; what is further than
/// `cut` mm, or meets no target point, counts as `cut`. What leaves the view does not count; `cut` when less
/// than a quarter stays in it.
double cut_residual(const FramePair& pair, const Eigen::Isometry3d& motion, double cut = 100);

/// Adds the alignment `automatic`.
void register_automatic_alignment(Registry& registry);

}  // namespace pliant
