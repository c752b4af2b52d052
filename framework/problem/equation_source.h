#pragma once

#include <string>
#include <string_view>

#include "framework/deformation/node_transform.h"
#include "framework/problem/energy.h"

namespace pliant {

/// A text that C++ and OpenCL C share (kernel_math.h) as OpenCL C over `real`.
std::string as_opencl(std::string_view source, const std::string& real);

/// The functions of an energy's equation.h as OpenCL C, over `real` ("float", or "float16" to run sixteen
/// instances at once).
std::string equation_source(const Energy& energy, const std::string& real);

/// The functions of a transform that is not free as OpenCL C, and the kernels of transform.cl over steps of
/// `stride` numbers a node.
std::string transform_source(const NodeTransform& transform, int stride);

/// The functions of loss.h as OpenCL C over `real`.
std::string losses_source(const std::string& real);

/// Makes LOSS_VALUE(s, scale) and LOSS_WEIGHT(s, scale) stand for one of them.
std::string loss_choice_source(const Loss& loss);

/// Both.
std::string loss_source(const Loss& loss, const std::string& real);

}  // namespace pliant
