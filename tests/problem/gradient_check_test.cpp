#include "tests/problem/gradient_check.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pliant::test {
namespace {

// A residual with a product, a constant factor, data and a root.
template <class Real>
void sample_residual(const Real* u, const Real* data, Real* r) {
  using std::sqrt;
  r[0] = u[0] * u[1] + data[0];
  r[1] = sqrt(u[2] * u[2] + 1.0) * data[1];
}

template <class Real>
void sample_jacobian(const Real* u, const Real* data, Real* J) {
  using std::sqrt;
  const Real values[6] = {u[1], u[0], Real(0), Real(0), Real(0), data[1] * u[2] / sqrt(u[2] * u[2] + 1.0)};
  for (int entry = 0; entry < 6; ++entry) J[entry] = values[entry];
}

// What the wrong Jacobian below does to the right one.
int broken_entry = 0;
double broken_factor = 1;
double broken_offset = 0;

void broken_jacobian(const double* u, const double* data, double* J) {
  sample_jacobian(u, data, J);
  J[broken_entry] = broken_factor * J[broken_entry] + broken_offset;
}

Energy sample() {
  return {.stencil = Stencil::per_constraint,
          .residuals = 2,
          .in_length = false,
          .equation = {"sample", "", &sample_residual<double>, &sample_jacobian<double>,
                       &sample_residual<Equation::Jet>},
          .weight = 1};
}

double error_when_broken(int entry, double factor, double offset) {
  broken_entry = entry;
  broken_factor = factor;
  broken_offset = offset;
  Energy energy = sample();
  energy.equation.jacobian = &broken_jacobian;
  return jacobian_error(energy, 1);
}

TEST(GradientCheck, ACorrectJacobianPasses) {
  EXPECT_LT(jacobian_error(sample(), 1), gradient_tolerance);
  EXPECT_LT(error_when_broken(0, 1, 0), gradient_tolerance);
}

TEST(GradientCheck, AnyEntryThatIsWrongIsCaught) {
  for (int entry = 0; entry < 6; ++entry)
    EXPECT_GT(error_when_broken(entry, 1, 1e-6), 100 * gradient_tolerance) << "offset of entry " << entry;
  for (const int entry : {0, 1, 5}) {
    EXPECT_GT(error_when_broken(entry, 1.001, 0), 100 * gradient_tolerance) << "factor of entry " << entry;
    EXPECT_GT(error_when_broken(entry, -1, 0), 100 * gradient_tolerance) << "sign of entry " << entry;
    EXPECT_GT(error_when_broken(entry, 0, 0), 100 * gradient_tolerance) << "missing entry " << entry;
  }
}

TEST(GradientCheck, WhatIsNotFiniteIsCaught) {
  EXPECT_FALSE(std::isfinite(error_when_broken(0, 1, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(std::isfinite(error_when_broken(0, 1, std::numeric_limits<double>::infinity())));
}

TEST(GradientCheck, AResidualThatDiffersBetweenNumbersAndJetsIsCaught) {
  Energy energy = sample();
  energy.equation.residual = [](const double* u, const double* data, double* r) {
    sample_residual(u, data, r);
    r[1] += 1e-9;
  };
  EXPECT_FALSE(std::isfinite(jacobian_error(energy, 1)));
}

}  // namespace
}  // namespace pliant::test
