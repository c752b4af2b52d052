#pragma once

#include "framework/problem/energy.h"

namespace pliant::test {

/// Largest difference between an energy's analytic Jacobian and that of its residual over jets, at `samples`
/// random points, each relative to the size of the Jacobian there. Infinite when the residual over jets is
/// not that over numbers, or when anything is not finite. A correct Jacobian stays below gradient_tolerance.
double jacobian_error(const Energy& energy, unsigned seed, int samples = 100);

inline constexpr double gradient_tolerance = 1e-11;

}  // namespace pliant::test
