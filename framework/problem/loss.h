// Robust losses rho(s) of an instance's squared residual s and their first derivatives, written once like the
// equations: compiled over double and jets for Ceres, and as OpenCL C for the device. `scale` is where a
// residual begins to count as an outlier. All are s near zero.
#pragma once
#ifndef __OPENCL_VERSION__
#include <cmath>
#endif
#include "framework/problem/equation.h"

PLIANT_EQUATION Real none_value(Real s, Real scale) {
  (void)scale;
  return s;
}
PLIANT_EQUATION Real none_weight(Real s, Real scale) {
  (void)scale;
  (void)s;
  return (Real)1;
}

// Huber 1964: linear beyond `scale`.
PLIANT_EQUATION Real huber_value(Real s, Real scale) {
  return s <= scale * scale ? s : (Real)2 * scale * sqrt(s) - scale * scale;
}
PLIANT_EQUATION Real huber_weight(Real s, Real scale) {
  return s <= scale * scale ? (Real)1 : scale / sqrt(s);
}

// Tukey's biweight (Beaton and Tukey 1974): constant beyond `scale`.
PLIANT_EQUATION Real tukey_value(Real s, Real scale) {
  const Real left = (Real)1 - s / (scale * scale);
  return s < scale * scale ? scale * scale / (Real)3 * ((Real)1 - left * left * left)
                           : scale * scale / (Real)3;
}
PLIANT_EQUATION Real tukey_weight(Real s, Real scale) {
  const Real left = (Real)1 - s / (scale * scale);
  return s < scale * scale ? left * left : (Real)0;
}

// Welsch (Dennis and Welsch 1978): approaches a constant smoothly.
PLIANT_EQUATION Real welsch_value(Real s, Real scale) {
  return scale * scale * ((Real)1 - exp(-s / (scale * scale)));
}
PLIANT_EQUATION Real welsch_weight(Real s, Real scale) { return exp(-s / (scale * scale)); }
