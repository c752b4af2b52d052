#pragma once
#include "framework/problem/equation.h"

// [Eq. 4.4]: where node `from` takes node `to`, against where `to` goes itself:
// R (g_to - g_from) + g_from + t_from - (g_to + t_to) = D e + t_from - t_to with e = g_to - g_from.
// u: columns of D and t of `from`, then those of `to`; data: e (mm); residual: mm.
PLIANT_EQUATION void regularization_residual(const Real* u, const Real* data, Real* r) {
  for (int axis = 0; axis < 3; ++axis)
    r[axis] = data[0] * u[axis] + data[1] * u[3 + axis] + data[2] * u[6 + axis] + u[9 + axis] - u[21 + axis];
}

PLIANT_EQUATION void regularization_jacobian(const Real* u, const Real* data, Real* J) {
  for (int entry = 0; entry < 72; ++entry) J[entry] = u[0] * 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int column = 0; column < 3; ++column) J[24 * axis + 3 * column + axis] = data[column];
    J[24 * axis + 9 + axis] = J[24 * axis + 9 + axis] + 1;
    J[24 * axis + 21 + axis] = J[24 * axis + 21 + axis] - 1;
  }
}

PLIANT_EQUATION void regularization_row(const Real* data, Real* row) {
  for (int column = 0; column < 3; ++column) {
    row[column] = data[column];
    row[4 + column] = 0;
  }
  row[3] = 1;
  row[7] = -1;
}
