// Rigid nodes: the affine form of a node (columns of D = R - I, then t) whose R is a rotation, and its
// motions along a step of 6 numbers: a turn about x, y, z (radians, for small ones) and an addition to t.
// Written once for C++ and OpenCL C. A quaternion is w x y z. Everything is computed in D, so that small
// rotations keep their digits in single precision.
#pragma once
#ifndef __OPENCL_VERSION__
#include <cmath>
#endif
#include "framework/device/kernel_math.h"

// The symmetric 4x4 matrix of R that is 4 q q^T where R is the rotation of q. For any R: M - I is Davenport's
// matrix, whose eigenvector of the largest eigenvalue is the rotation most alike to R.
PLIANT_EQUATION void quaternion_products(const Real* D, Real* M) {
  M[0] = (Real)4 + D[0] + D[4] + D[8];
  M[5] = D[0] - D[4] - D[8];
  M[10] = D[4] - D[0] - D[8];
  M[15] = D[8] - D[0] - D[4];
  M[1] = M[4] = D[5] - D[7];
  M[2] = M[8] = D[6] - D[2];
  M[3] = M[12] = D[1] - D[3];
  M[6] = M[9] = D[1] + D[3];
  M[7] = M[13] = D[2] + D[6];
  M[11] = M[14] = D[5] + D[7];
}

PLIANT_EQUATION void quaternion_normalise(const Real* v, Real* q) {
  const Real length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]);
  for (int i = 0; i < 4; ++i) q[i] = v[i] / length;
}

// q of a positive multiple of q q^T: its longest column.
PLIANT_EQUATION void quaternion_of_products(const Real* M, Real* q) {
  int longest = 0;
  for (int i = 1; i < 4; ++i)
    if (M[5 * i] > M[5 * longest]) longest = i;
  quaternion_normalise(M + 4 * longest, q);
}

PLIANT_EQUATION void quaternion_to_deviation(const Real* q, Real* D) {
  const Real two = (Real)2;
  D[0] = -two * (q[2] * q[2] + q[3] * q[3]);
  D[4] = -two * (q[1] * q[1] + q[3] * q[3]);
  D[8] = -two * (q[1] * q[1] + q[2] * q[2]);
  D[1] = two * (q[1] * q[2] + q[0] * q[3]);
  D[3] = two * (q[1] * q[2] - q[0] * q[3]);
  D[2] = two * (q[1] * q[3] - q[0] * q[2]);
  D[6] = two * (q[1] * q[3] + q[0] * q[2]);
  D[5] = two * (q[2] * q[3] + q[0] * q[1]);
  D[7] = two * (q[2] * q[3] - q[0] * q[1]);
}

// Moves a rotation along a step: R' = R(1, turn / 2) R, t' = t + the rest. No turn reaches 180 degrees.
PLIANT_EQUATION void quaternion_retract(const Real* form, const Real* step, Real* moved) {
  Real M[16], p[4], product[4], q[4];
  quaternion_products(form, M);
  quaternion_of_products(M, p);
  const Real a = step[0] / (Real)2, b = step[1] / (Real)2, c = step[2] / (Real)2;
  product[0] = p[0] - (a * p[1] + b * p[2] + c * p[3]);
  product[1] = p[1] + (a * p[0] + b * p[3] - c * p[2]);
  product[2] = p[2] + (b * p[0] + c * p[1] - a * p[3]);
  product[3] = p[3] + (c * p[0] + a * p[2] - b * p[1]);
  quaternion_normalise(product, q);
  quaternion_to_deviation(q, moved);
  for (int axis = 0; axis < 3; ++axis) moved[9 + axis] = form[9 + axis] + step[3 + axis];
}

// T^T v, T being the derivative of the moved form by a step of zero: with w the turn, column c of R moves by
// w x c, so what pulls at c by v pulls at w by c x v.
PLIANT_EQUATION void quaternion_pull_back(const Real* form, const Real* v, Real* pulled) {
  for (int axis = 0; axis < 3; ++axis) {
    const int y = (axis + 1) % 3, z = (axis + 2) % 3;
    Real sum = v[0] * (Real)0;
    for (int column = 0; column < 3; ++column) {
      const Real cy = form[3 * column + y] + (Real)(column == y);
      const Real cz = form[3 * column + z] + (Real)(column == z);
      sum = sum + cy * v[3 * column + z] - cz * v[3 * column + y];
    }
    pulled[axis] = sum;
    pulled[3 + axis] = v[9 + axis];
  }
}

// The form whose R is the rotation nearest to that of `form`, with the same t. Where several are equally near
// it is always the same one of the rotations. NaN stays NaN.
PLIANT_EQUATION void quaternion_nearest(const Real* form, Real* nearest) {
  Real M[16], square[16], q[4];
  quaternion_products(form, M);
  // No eigenvalue of Davenport's matrix lies further from zero than sqrt(3) |R|.
  Real size = form[0] * (Real)0;
  for (int entry = 0; entry < 9; ++entry) {
    const Real value = form[entry] + (Real)(entry % 4 == 0);
    size = size + value * value;
  }
  for (int i = 0; i < 4; ++i) M[5 * i] = M[5 * i] + sqrt((Real)3 * size);
  // M^1024: what is left of it is the largest eigenvalue's vector.
  for (int round = 0; round < 10; ++round) {
    const Real trace = M[0] + M[5] + M[10] + M[15];
    for (int entry = 0; entry < 16; ++entry) M[entry] = M[entry] / trace;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        square[4 * row + column] = M[4 * row] * M[4 * column] + M[4 * row + 1] * M[4 * column + 1] +
                                   M[4 * row + 2] * M[4 * column + 2] + M[4 * row + 3] * M[4 * column + 3];
    for (int entry = 0; entry < 16; ++entry) M[entry] = square[entry];
  }
  quaternion_of_products(M, q);
  quaternion_to_deviation(q, nearest);
  for (int axis = 9; axis < 12; ++axis) nearest[axis] = form[axis];
}
