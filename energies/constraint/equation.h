#pragma once
#include "framework/problem/equation.h"

// [Eq. 4.5]: p' - q = (p' - p) - (q - p). u: displacement p' - p; data: q - p, normal; all in mm.
PLIANT_EQUATION void constraint_residual(const Real* u, const Real* data, Real* r) {
  for (int axis = 0; axis < 3; ++axis) r[axis] = u[axis] - data[axis];
}

PLIANT_EQUATION void constraint_jacobian(const Real* u, const Real* data, Real* J) {
  (void)data;
  for (int entry = 0; entry < 9; ++entry) J[entry] = u[0] * 0;
  for (int axis = 0; axis < 3; ++axis) J[4 * axis] = J[4 * axis] + 1;
}

PLIANT_EQUATION void constraint_row(const Real* data, Real* row) {
  (void)data;
  row[0] = 1;
}
