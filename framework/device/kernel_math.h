// Makes one text compile as C++ (over double and ceres::Jet) and as OpenCL C (over float): a function that is
// marked PLIANT_EQUATION computes in `Real`.
#ifndef PLIANT_EQUATION
#ifdef __OPENCL_VERSION__
#define PLIANT_EQUATION static inline
#else
#define PLIANT_EQUATION \
  template <class Real> \
  inline
#endif
#endif
