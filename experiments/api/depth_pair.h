#pragma once

#include "experiments/api/register_depth.h"
#include "framework/geometry/frame.h"

namespace pliant {

/// Copies of two views as a pair, with a warning for what is odd about their depth. Throws DataError as
/// DepthRegistration::run does for its arrays and the size of the camera's images.
FramePair make_depth_pair(const DepthView& source, const DepthView& target, const Camera& camera);

}  // namespace pliant
