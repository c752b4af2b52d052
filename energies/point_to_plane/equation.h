#pragma once
#include "framework/problem/equation.h"

// Distance of the moved point to the tangent plane of its target point (Chen and Medioni 1992):
// n . (p' - q) = n . ((p' - p) - (q - p)). u: displacement p' - p; data: q - p, then the unit normal n at q;
// a target without a normal, n = 0, asks for nothing. Residual: mm.
PLIANT_EQUATION void point_to_plane_residual(const Real* u, const Real* data, Real* r) {
  r[0] = data[3] * (u[0] - data[0]) + data[4] * (u[1] - data[1]) + data[5] * (u[2] - data[2]);
}

PLIANT_EQUATION void point_to_plane_jacobian(const Real* u, const Real* data, Real* J) {
  for (int axis = 0; axis < 3; ++axis) J[axis] = u[0] * 0 + data[3 + axis];
}
