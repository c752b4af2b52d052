// One match of rigid ICP: point to plane [Eq. 3.2], written once for C++ and OpenCL C.
#pragma once
#include "framework/device/kernel_math.h"

// Distance of a point to the tangent plane of its match, mm. offset: from the match to the point; normal:
// unit normal at the match.
PLIANT_EQUATION Real plane_distance(const Real* offset, const Real* normal) {
  return normal[0] * offset[0] + normal[1] * offset[1] + normal[2] * offset[2];
}

// How it changes with a small motion: a turn about a pivot (3, radians), then a shift (3, mm). arm: from the
// pivot to the point.
PLIANT_EQUATION void plane_distance_jacobian(const Real* arm, const Real* normal, Real* J) {
  J[0] = arm[1] * normal[2] - arm[2] * normal[1];
  J[1] = arm[2] * normal[0] - arm[0] * normal[2];
  J[2] = arm[0] * normal[1] - arm[1] * normal[0];
  for (int axis = 0; axis < 3; ++axis) J[3 + axis] = normal[axis];
}
