#pragma once
#include "framework/problem/equation.h"

// Equations of terms that no registered energy is like: rows that couple the axes of a constraint, of an
// edge, and a term per node that separates.

// Distance to the target's tangent plane; data: q - p, normal.
PLIANT_EQUATION void to_plane_residual(const Real* u, const Real* data, Real* r) {
  r[0] = data[3] * (u[0] - data[0]) + data[4] * (u[1] - data[1]) + data[5] * (u[2] - data[2]);
}
PLIANT_EQUATION void to_plane_jacobian(const Real* u, const Real* data, Real* J) {
  for (int axis = 0; axis < 3; ++axis) J[axis] = data[3 + axis] + u[axis] * 0;
}

// Difference of the squared lengths of displacement and wish: not linear in the displacement.
PLIANT_EQUATION void moves_as_far_residual(const Real* u, const Real* data, Real* r) {
  r[0] = (u[0] - data[0]) * (u[0] + data[0]) + (u[1] - data[1]) * (u[1] + data[1]) +
         (u[2] - data[2]) * (u[2] + data[2]);
}
PLIANT_EQUATION void moves_as_far_jacobian(const Real* u, const Real* data, Real* J) {
  for (int axis = 0; axis < 3; ++axis) J[axis] = u[axis] + u[axis] + data[axis] * 0;
}

// What an edge gains in squared length; data: g_to - g_from.
PLIANT_EQUATION void keeps_length_residual(const Real* u, const Real* data, Real* r) {
  Real gain[3];
  for (int axis = 0; axis < 3; ++axis) gain[axis] = u[21 + axis] - u[9 + axis];
  r[0] = gain[0] * (data[0] + data[0] + gain[0]) + gain[1] * (data[1] + data[1] + gain[1]) +
         gain[2] * (data[2] + data[2] + gain[2]);
}
PLIANT_EQUATION void keeps_length_jacobian(const Real* u, const Real* data, Real* J) {
  for (int entry = 0; entry < 24; ++entry) J[entry] = u[0] * 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Real half_slope = data[axis] + u[21 + axis] - u[9 + axis];
    J[21 + axis] = half_slope + half_slope;
    J[9 + axis] = -J[21 + axis];
  }
}

// Holds nodes where they are.
PLIANT_EQUATION void stays_residual(const Real* u, const Real* data, Real* r) {
  (void)data;
  for (int axis = 0; axis < 3; ++axis) r[axis] = u[9 + axis];
}
PLIANT_EQUATION void stays_jacobian(const Real* u, const Real* data, Real* J) {
  (void)data;
  for (int entry = 0; entry < 36; ++entry) J[entry] = u[0] * 0;
  for (int axis = 0; axis < 3; ++axis) J[12 * axis + 9 + axis] = J[12 * axis + 9 + axis] + 1;
}
PLIANT_EQUATION void stays_row(const Real* data, Real* row) {
  (void)data;
  for (int column = 0; column < 3; ++column) row[column] = 0;
  row[3] = 1;
}
