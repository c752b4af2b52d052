// What an energy's equation.h is written with: one text for C++ and OpenCL C, see kernel_math.h.
//
// An equation.h defines two functions, NAME_residual and NAME_jacobian, each marked PLIANT_EQUATION:
//
//   PLIANT_EQUATION void NAME_residual(const Real* u, const Real* data, Real* r)
//   PLIANT_EQUATION void NAME_jacobian(const Real* u, const Real* data, Real* J)   // row-major, r by u
//
// A term that treats the axes x, y and z alike and apart says so by a third function, its scalar row:
//
//   PLIANT_EQUATION void NAME_row(const Real* data, Real* row)   // r[axis] = row . u[axis of each] +
//   constant
//
// Then the fast solver `structured` needs 16 numbers where others need 144.
//
// All of them in the common subset of both languages: arithmetic, local arrays, loops with constant bounds;
// no allocation, no library calls but sqrt. What u and data hold is fixed by the stencil (energy.h). On
// the device they are run over vectors of instances: no branches, but `condition ? a : b` between values.
#include "framework/device/kernel_math.h"
