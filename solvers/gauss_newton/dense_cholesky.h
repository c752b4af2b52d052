#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// Adds the linear solver `dense_cholesky` [thesis 4.6]: blocked L L^T and triangular solves in kernels of
/// our own, single precision. Memory grows with the square of the unknowns.
void register_dense_cholesky(Registry& registry);

}  // namespace pliant
