// Makes one text compile as C++ (over double and ceres::Jet) and as OpenCL C (over float).
//
// An equation.h defines two functions, NAME_residual and NAME_jacobian, each marked PLIANT_EQUATION:
//
//   PLIANT_EQUATION void NAME_residual(const Real* u, const Real* data, Real* r)
//   PLIANT_EQUATION void NAME_jacobian(const Real* u, const Real* data, Real* J)   // row-major, r by u
//
// in the common subset of both languages: arithmetic, local arrays, loops with constant bounds; no
// allocation, no library calls but sqrt. What u and data hold is fixed by the stencil (energy.h).
#ifndef PLIANT_EQUATION
#ifdef __OPENCL_VERSION__
#define PLIANT_EQUATION static inline
#else
#define PLIANT_EQUATION \
  template <class Real> \
  inline
#endif
#endif
