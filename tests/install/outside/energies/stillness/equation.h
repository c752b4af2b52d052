#pragma once
#include "pliant/equation.h"

// How far the node is from where it was. u: columns of D, then t (mm); residual: all of them.
PLIANT_EQUATION void stillness_residual(const Real* u, const Real* data, Real* r) {
  (void)data;
  for (int i = 0; i < 12; ++i) r[i] = u[i];
}

PLIANT_EQUATION void stillness_jacobian(const Real* u, const Real* data, Real* J) {
  (void)data;
  for (int entry = 0; entry < 144; ++entry) J[entry] = u[0] * 0;
  for (int i = 0; i < 12; ++i) J[13 * i] = J[13 * i] + 1;
}
