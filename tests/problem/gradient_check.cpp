#include "tests/problem/gradient_check.h"

#include <ceres/jet.h>

#include <Eigen/Core>
#include <array>
#include <limits>
#include <random>

namespace pliant::test {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Jet = Equation::Jet;

double error_at(const Energy& energy, const std::array<double, max_stencil_inputs>& u,
                const std::array<double, max_stencil_data>& data) {
  const int inputs = input_size(energy.stencil);
  std::array<Jet, max_stencil_inputs> jet_u;
  for (int i = 0; i < inputs; ++i)
    jet_u[static_cast<std::size_t>(i)] = Jet(u[static_cast<std::size_t>(i)], i);
  std::array<Jet, max_stencil_data> jet_data;
  for (std::size_t i = 0; i < data.size(); ++i) jet_data[i] = Jet(data[i]);
  std::array<Jet, max_residuals> jet_r;
  std::array<double, max_residuals> r{};
  Matrix analytic(energy.residuals, inputs);
  energy.equation.residual_jet(jet_u.data(), jet_data.data(), jet_r.data());
  energy.equation.residual(u.data(), data.data(), r.data());
  energy.equation.jacobian(u.data(), data.data(), analytic.data());

  Matrix exact(energy.residuals, inputs);
  for (int row = 0; row < energy.residuals; ++row) {
    const auto& jet = jet_r[static_cast<std::size_t>(row)];
    if (jet.a != r[static_cast<std::size_t>(row)]) return std::numeric_limits<double>::infinity();
    exact.row(row) = jet.v.head(inputs).transpose();
  }
  if (!analytic.allFinite() || !exact.allFinite()) return std::numeric_limits<double>::infinity();
  return (analytic - exact).cwiseAbs().maxCoeff() / (1 + exact.cwiseAbs().maxCoeff());
}

}  // namespace

double jacobian_error(const Energy& energy, unsigned seed, int samples) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int sample = 0; sample < samples; ++sample) {
    std::array<double, max_stencil_inputs> u{};
    std::array<double, max_stencil_data> data{};
    for (auto& value : u) value = normal(generator);
    for (auto& value : data) value = normal(generator);
    worst = std::max(worst, error_at(energy, u, data));
  }
  return worst;
}

}  // namespace pliant::test
