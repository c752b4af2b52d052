#pragma once

#include <string>

#include "framework/deformation/node_transform.h"
#include "framework/problem/energy.h"

namespace pliant {

/// The functions of an energy's equation.h as OpenCL C, over `real` ("float", or "float16" to run sixteen
/// instances at once).
std::string equation_source(const Energy& energy, const std::string& real);

/// The functions of a transform that is not free as OpenCL C, and the kernels of transform.cl over steps of
/// `stride` numbers a node.
std::string transform_source(const NodeTransform& transform, int stride);

/// The functions of loss.h as OpenCL C over `real`, and LOSS_VALUE(s, scale), LOSS_WEIGHT(s, scale) for one
/// of them.
std::string loss_source(const Loss& loss, const std::string& real);

}  // namespace pliant
