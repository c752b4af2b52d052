#pragma once

#include <ceres/jet.h>

#include "framework/problem/energy.h"

/// Fills an Equation from the functions of an included equation.h and its embedded text.
#define PLIANT_MAKE_EQUATION(NAME, SOURCE)                                 \
  ::pliant::Equation {                                                     \
#NAME, SOURCE, &NAME##_residual < double>, &NAME##_jacobian < double>, \
        &NAME##_residual < ::pliant::Equation::Jet>, nullptr               \
  }
/// The same for an equation.h that also defines NAME_row.
#define PLIANT_MAKE_SEPARABLE_EQUATION(NAME, SOURCE)                       \
  ::pliant::Equation {                                                     \
#NAME, SOURCE, &NAME##_residual < double>, &NAME##_jacobian < double>, \
        &NAME##_residual < ::pliant::Equation::Jet>, &NAME##_row < double> \
  }
