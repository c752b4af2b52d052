// Two views of one point and their focal length, written once for C++ and OpenCL C.
#pragma once
#include "framework/device/kernel_math.h"

// How the distance of a point of one view, moved to another, to the tangent plane of its match there changes
// with a relative change of the focal length that both views were made with, mm: a point (x, y, z) of a view
// becomes (x, y, z) - (x, y, 0) ds. first_point, first_normal: in the first view's frame; point, normal: the
// same, moved to the other view's.
PLIANT_EQUATION Real plane_distance_by_focal_length(const Real* first_point, const Real* first_normal,
                                                    const Real* point, const Real* normal) {
  return normal[0] * point[0] + normal[1] * point[1] - first_normal[0] * first_point[0] -
         first_normal[1] * first_point[1];
}
