#pragma once

#include "framework/core/registry.h"
#include "solvers/ceres_lm/ceres_lm.h"
#include "solvers/gauss_newton/automatic.h"
#include "solvers/gauss_newton/block_pcg.h"
#include "solvers/gauss_newton/dense_cholesky.h"
#include "solvers/gauss_newton/gauss_newton.h"
#include "solvers/gauss_newton/structured.h"

namespace pliant {

/// Adds every solver and linear solver.
inline void register_solvers(Registry& registry) {
  register_gauss_newton(registry);
  register_ceres_lm(registry);
  register_automatic(registry);
  register_structured(registry);
  register_block_pcg(registry);
  register_dense_cholesky(registry);
}

}  // namespace pliant
