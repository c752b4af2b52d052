#pragma once
#include "pliant/equation.h"

// How far the node moves. u: columns of D, then t (mm); residual: t.
PLIANT_EQUATION void stillness_residual(const Real* u, const Real* data, Real* r) {
  (void)data;
  for (int axis = 0; axis < 3; ++axis) r[axis] = u[9 + axis];
}

PLIANT_EQUATION void stillness_jacobian(const Real* u, const Real* data, Real* J) {
  (void)data;
  for (int entry = 0; entry < 36; ++entry) J[entry] = u[0] * 0;
  for (int axis = 0; axis < 3; ++axis) J[12 * axis + 9 + axis] = J[12 * axis + 9 + axis] + 1;
}
