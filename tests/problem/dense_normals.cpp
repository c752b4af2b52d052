#include "tests/problem/dense_normals.h"

#include <array>
#include <numeric>

#include "framework/deformation/warp.h"

namespace pliant::test {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// d u / d (unknowns of the node in `slot`).
Eigen::MatrixXd inner_derivative(const Problem& problem, const Term& term, std::size_t instance, int slot) {
  Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(input_size(term.energy.stencil), affine_size);
  if (!term.constraints) {
    inner.middleRows(affine_size * slot, affine_size).setIdentity();
    return inner;
  }
  const auto& influences = term.constraints->influences;
  const auto entry =
      instance * static_cast<std::size_t>(influences.per_point) + static_cast<std::size_t>(slot);
  const Eigen::Vector3d point =
      Eigen::Map<const Eigen::Vector3f>(term.constraints->points.host().data() + 3 * instance).cast<double>();
  const auto node = static_cast<std::size_t>(influences.nodes.host()[entry]);
  const double weight = influences.weights.host()[entry];
  Eigen::Vector4d arm;
  arm << point - problem.graph().nodes[node].cast<double>(), 1;
  for (int column = 0; column < 4; ++column)
    inner.middleCols<3>(3 * column) = weight * arm[column] * Eigen::Matrix3d::Identity();
  return inner;
}

void add_instance(const Problem& problem, const Term& term, std::size_t instance, const double* unknowns,
                  DenseNormals& normals) {
  const double confidence = term.constraints ? term.constraints->confidence.host()[instance] : 1.0;
  if (confidence <= 0) return;
  std::array<double, max_stencil_inputs> u{};
  std::array<double, max_stencil_data> data{};
  gather_instance(problem, term, instance, unknowns, u.data(), data.data());
  Eigen::VectorXd r(term.energy.residuals);
  Matrix outer(term.energy.residuals, input_size(term.energy.stencil));
  term.energy.equation.residual(u.data(), data.data(), r.data());
  term.energy.equation.jacobian(u.data(), data.data(), outer.data());

  const auto nodes = coupled_nodes(problem, term, instance);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(term.energy.residuals, affine_size * problem.node_count());
  for (std::size_t slot = 0; slot < nodes.size(); ++slot)
    J.middleCols(affine_size * nodes[slot], affine_size) +=
        outer * inner_derivative(problem, term, instance, static_cast<int>(slot));
  const double factor =
      problem.effective_weight(term) * confidence * term.energy.loss.weight(r.squaredNorm());
  for (const int a : nodes) {
    const auto left = J.middleCols(affine_size * a, affine_size).transpose();
    normals.gradient.segment(affine_size * a, affine_size) += factor * left * r;
    for (const int b : nodes)
      normals.matrix.block(affine_size * a, affine_size * b, affine_size, affine_size) +=
          factor * left * J.middleCols(affine_size * b, affine_size);
  }
}

/// The derivative of all affine forms by the steps of their nodes.
Eigen::MatrixXd tangents(const Problem& problem, const double* forms) {
  const int width = problem.transform().unknowns;
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(affine_size * problem.node_count(), problem.unknown_count());
  for (int node = 0; node < problem.node_count(); ++node)
    for (int entry = 0; entry < affine_size; ++entry) {
      const Eigen::VectorXd one = Eigen::VectorXd::Unit(affine_size, entry);
      Eigen::VectorXd row(width);
      problem.transform().pull_back(forms + affine_size * node, one.data(), row.data());
      T.block(affine_size * node + entry, width * node, 1, width) = row.transpose();
    }
  return T;
}

std::vector<float> read(Device& device, const Buffer& buffer, std::size_t count) {
  std::vector<float> values(count);
  device.read(buffer, values.data(), sizeof(float) * count);
  return values;
}

}  // namespace

DenseNormals dense_normals(const Problem& problem) {
  const auto size = affine_size * problem.node_count();
  DenseNormals normals{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  const auto& values = problem.unknowns().host();
  const std::vector<double> unknowns(values.begin(), values.end());
  for (const auto& term : problem.terms())
    for (std::size_t i = 0; i < instance_count(problem, term); ++i)
      add_instance(problem, term, i, unknowns.data(), normals);
  if (problem.transform().is_free()) return normals;
  const Eigen::MatrixXd T = tangents(problem, unknowns.data());
  return {T.transpose() * normals.matrix * T, T.transpose() * normals.gradient};
}

DenseNormals device_normals(NormalEquations& equations) {
  auto& device = equations.device();
  equations.assemble(make_status(device));
  const int width = equations.stride();
  const auto size = width * equations.node_count();
  const auto entries = static_cast<std::size_t>(width * width);
  const auto blocks = read(device, equations.blocks(), entries * equations.block_rows().size());
  const auto gradient = read(device, equations.gradient(), static_cast<std::size_t>(size));
  DenseNormals normals{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  for (std::size_t pair = 0; pair < equations.block_rows().size(); ++pair) {
    const int row = width * equations.block_rows().host()[pair];
    const int column = width * equations.block_columns().host()[pair];
    using Block = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::MatrixXd block =
        Eigen::Map<const Block>(blocks.data() + entries * pair, width, width).cast<double>();
    normals.matrix.block(column, row, width, width) = block.transpose();
    normals.matrix.block(row, column, width, width) = block;
  }
  for (int i = 0; i < size; ++i) normals.gradient[i] = gradient[static_cast<std::size_t>(i)];
  return normals;
}

double device_energy(NormalEquations& equations, const Problem& problem) {
  auto& device = equations.device();
  equations.sum_energy(problem.unknowns().device(device), make_status(device));
  const auto partials =
      read(device, equations.energy_partials(), static_cast<std::size_t>(equations.energy_partial_count()));
  return std::accumulate(partials.begin(), partials.end(), 0.0);
}

Buffer make_status(Device& device) {
  constexpr std::size_t bytes = 4096;  // more words than any solver keeps
  auto status = device.allocate(bytes);
  device.fill_zero(status, bytes);
  return status;
}

}  // namespace pliant::test
