#pragma once
#include "framework/problem/equation.h"

// Rot(R) of [Eq. 4.2, 4.3]: how far the columns of R are from an orthonormal frame. With R = I + D the
// products are written in D, so that small deviations keep their digits in single precision:
// c_i . c_j - delta_ij = D_ij + D_ji + d_i . d_j.

// Residuals: c1.c2, c1.c3, c2.c3, c1.c1 - 1, c2.c2 - 1, c3.c3 - 1. u: columns of D, then t.
PLIANT_EQUATION void rotation_residual(const Real* u, const Real* data, Real* r) {
  (void)data;
  const int first[6] = {0, 0, 1, 0, 1, 2};
  const int second[6] = {1, 2, 2, 0, 1, 2};
  for (int row = 0; row < 6; ++row) {
    const int a = first[row];
    const int b = second[row];
    r[row] = u[3 * a + b] + u[3 * b + a] + u[3 * a] * u[3 * b] + u[3 * a + 1] * u[3 * b + 1] +
             u[3 * a + 2] * u[3 * b + 2];
  }
}

PLIANT_EQUATION void rotation_jacobian(const Real* u, const Real* data, Real* J) {
  (void)data;
  const int first[6] = {0, 0, 1, 0, 1, 2};
  const int second[6] = {1, 2, 2, 0, 1, 2};
  for (int entry = 0; entry < 72; ++entry) J[entry] = u[0] * 0;
  for (int row = 0; row < 6; ++row) {
    const int a = first[row];
    const int b = second[row];
    for (int axis = 0; axis < 3; ++axis) {
      J[12 * row + 3 * a + axis] = J[12 * row + 3 * a + axis] + u[3 * b + axis];
      J[12 * row + 3 * b + axis] = J[12 * row + 3 * b + axis] + u[3 * a + axis];
    }
    J[12 * row + 3 * a + b] = J[12 * row + 3 * a + b] + 1;
    J[12 * row + 3 * b + a] = J[12 * row + 3 * b + a] + 1;
  }
}
