#include "tests/solvers_pcg/reference_minimiser.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/deformation/warp.h"
#include "solvers/gauss_newton/linear_solver.h"
#include "tests/problem/dense_normals.h"

namespace pliant::test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Block = Eigen::Matrix<double, affine_size, affine_size>;

constexpr double rounding = 3.6e-15;  // ROUNDING in minimiser.cl

/// Where unknown m of the kernels stands among those of the caller.
int columnwise(int m) {
  return m / affine_size * affine_size + 3 * (m % affine_size % 4) + m % affine_size / 4;
}

/// Directions of rounding errors that must not cancel: the signs of minimiser.cl.
double sign(int m) {
  constexpr std::array<int, 16> of_lane{1, 1, -1, 1, -1, -1, 1, -1, -1, 1, 1, 1, -1, 1, -1, -1};
  return of_lane.at(static_cast<std::size_t>(m / affine_size % 16)) * (m % affine_size % 3 == 1 ? -1 : 1);
}

/// The inverse that the preconditioner takes for that of a diagonal block: what nothing determines gets zero.
Block inverse_of(const Block& block) {
  Block L = Block::Identity(), rest = block;
  Eigen::Matrix<double, affine_size, 1> inverse_pivots;
  for (int k = 0; k < affine_size; ++k) {
    const double pivot = rest(k, k);
    inverse_pivots[k] = pivot > std::max(1e-5 * block(k, k), 1e-30) ? 1 / pivot : 0;
    L.col(k).tail(affine_size - 1 - k) = inverse_pivots[k] * rest.col(k).tail(affine_size - 1 - k);
    rest -= inverse_pivots[k] * rest.col(k) * rest.row(k).eval();
  }
  const Block inverse_L = L.inverse();
  return inverse_L.transpose() * inverse_pivots.asDiagonal() * inverse_L;
}

}  // namespace

struct ReferenceMinimiser::LinearSystem {
  MatrixXd A;                // damped J^T J
  VectorXd right_hand_side;  // -J^T r
  MatrixXd preconditioner;

  LinearSystem(const Problem& problem, double damping) {
    const auto normals = dense_normals(problem);
    const auto size = normals.gradient.size();
    A = MatrixXd::NullaryExpr(size, size, [&](Eigen::Index row, Eigen::Index column) {
      return normals.matrix(columnwise(static_cast<int>(row)), columnwise(static_cast<int>(column)));
    });
    right_hand_side = VectorXd::NullaryExpr(
        size, [&](Eigen::Index m) { return -normals.gradient[columnwise(static_cast<int>(m))]; });
    A.diagonal() *= 1 + damping;
    preconditioner = MatrixXd::Zero(size, size);
    for (Eigen::Index at = 0; at < size; at += affine_size)
      preconditioner.block<affine_size, affine_size>(at, at) =
          inverse_of(A.block<affine_size, affine_size>(at, at));
  }

  /// What the preconditioner makes of rounding errors in the right-hand side. `mean`: energy a node; `moved`:
  /// how far the unknowns are from where the gradient was summed.
  double noise(double mean, const VectorXd& moved) const {
    double sum = 0;
    for (Eigen::Index at = 0; at < A.rows(); at += affine_size) {
      const VectorXd diagonal = A.diagonal().segment<affine_size>(at);
      const VectorXd errors = VectorXd::NullaryExpr(affine_size, [&](Eigen::Index m) {
        return sign(static_cast<int>(at + m)) * std::sqrt(diagonal[m]);
      });
      const double size = mean + diagonal.dot(moved.segment<affine_size>(at).cwiseAbs2());
      sum += size * errors.dot(preconditioner.block<affine_size, affine_size>(at, at) * errors);
    }
    return rounding * sum;
  }

  /// The step, and how many iterations it took.
  std::pair<VectorXd, int> conjugate_gradients(double least) const {
    VectorXd step = VectorXd::Zero(A.rows()), residual = right_hand_side;
    VectorXd direction = preconditioner * residual;
    double rz = residual.dot(direction), gained = 0;
    for (int iteration = 1; rz > least; ++iteration) {
      const VectorXd product = A * direction;
      const double alpha = rz / direction.dot(product);
      gained += alpha * rz;
      step += alpha * direction;
      if (alpha * rz * std::max(iteration, 5) < 0.002 * gained) return {step, iteration};
      residual -= alpha * product;
      const VectorXd z = preconditioner * residual;
      const double next = residual.dot(z);
      direction = z + next / rz * direction;
      rz = next;
      if (rz <= least) return {step, iteration};
    }
    return {step, 0};
  }
};

ReferenceMinimiser::ReferenceMinimiser(Problem& problem, int max_iterations, double tolerance,
                                       double least_damping)
    : problem_(problem),
      max_iterations_(max_iterations),
      tolerance_(tolerance),
      least_damping_(least_damping),
      energy_(problem.energy()),
      initial_energy_(energy_),
      summed_energy_(energy_),
      damping_(least_damping),
      summed_at_(unknowns()) {}

VectorXd ReferenceMinimiser::unknowns() const {
  const auto& host = problem_.unknowns().host();
  return VectorXd::NullaryExpr(static_cast<Eigen::Index>(host.size()), [&](Eigen::Index m) {
    return static_cast<double>(host[static_cast<std::size_t>(columnwise(static_cast<int>(m)))]);
  });
}

void ReferenceMinimiser::iterate() {
  if (termination_ != 0) return;
  const LinearSystem system(problem_, damping_);
  const double noise = system.noise(4 * summed_energy_ / problem_.node_count(), unknowns() - summed_at_);
  const double threshold = tolerance_ * std::max(energy_, 1e-9 * initial_energy_);
  const double spread = std::max(1.0, most_cg_iterations_ * most_cg_iterations_ / 16.0);
  const auto [step, used] = system.conjugate_gradients(std::max(0.1 * threshold, noise) / spread);
  most_cg_iterations_ = std::max(most_cg_iterations_, used);
  const double change = used > 0 ? try_step(step) : 0;
  if (used > 0) {
    ++iterations_;
    linear_iterations_ += used;
  }
  judge(change, threshold, noise);
}

/// Keeps a step that lowers the energy, else damps. Returns what the step changes the energy by.
double ReferenceMinimiser::try_step(const VectorXd& step) {
  const std::vector<float> before = problem_.unknowns().host();
  auto& values = problem_.unknowns().write_host();
  for (Eigen::Index m = 0; m < step.size(); ++m)
    values[static_cast<std::size_t>(columnwise(static_cast<int>(m)))] += static_cast<float>(step[m]);
  const double change = problem_.energy() - energy_;
  if (change <= 0) {
    energy_ += change;
    damping_ = std::max(0.1 * damping_, least_damping_);
  } else {
    values = before;
    damping_ = 10 * std::max(damping_, 1e-6);
  }
  return change;
}

void ReferenceMinimiser::judge(double change, double threshold, double noise) {
  const bool settled = std::abs(change) <= std::max(threshold, noise);
  if (settled && (fresh_ || noise <= threshold))
    termination_ = termination_converged;
  else if (iterations_ >= max_iterations_)
    termination_ = termination_max_iterations;
  fresh_ = termination_ == 0 && settled;
  if (!fresh_) return;
  summed_at_ = unknowns();
  summed_energy_ = energy_;
}

}  // namespace pliant::test
