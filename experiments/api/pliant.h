#pragma once

/// All of the public C++ interface but make_equation.h, which brings Ceres with it.
#include "experiments/api/register_depth.h"
#include "experiments/runner/components.h"
#include "framework/core/error.h"
#include "framework/core/log.h"
#include "framework/core/parameters.h"
#include "framework/core/registry.h"
#include "framework/geometry/camera.h"
#include "framework/problem/energy.h"
