#pragma once

#include <string>

#include "framework/problem/energy.h"

namespace pliant {

/// The functions of an energy's equation.h as OpenCL C, over `real` ("float", or "float16" to run sixteen
/// instances at once).
std::string equation_source(const Energy& energy, const std::string& real);

}  // namespace pliant
