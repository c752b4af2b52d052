#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the solver `ceres_lm`: Levenberg-Marquardt of Ceres in double on the host, the ground truth.
void register_ceres_lm(Registry& registry);

}  // namespace pliant
