#include "solvers/ceres_lm/ceres_lm.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/deformation/warp.h"
#include "framework/problem/solver.h"

namespace pliant {
namespace {

/// One instance of a term with the analytic Jacobian of its equation, chained through the influences.
class InstanceCost : public ceres::CostFunction {
 public:
  InstanceCost(const Problem& problem, const Term& term, std::size_t instance, std::vector<int> nodes,
               const double* start)
      : term_(term), nodes_(std::move(nodes)) {
    set_num_residuals(term.energy.residuals);
    for (std::size_t i = 0; i < nodes_.size(); ++i) mutable_parameter_block_sizes()->push_back(affine_size);
    scale_ = std::sqrt(problem.effective_weight(term));
    std::array<double, max_stencil_inputs> u{};
    gather_instance(problem, term, instance, start, u.data(), data_.data());
    if (term.constraints == nullptr) return;
    scale_ *= std::sqrt(static_cast<double>(term.constraints->confidence.host()[instance]));
    const auto k = nodes_.size();
    for (std::size_t slot = 0; slot < k; ++slot) {
      const double weight = term.constraints->influences.weights.host()[instance * k + slot];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double p = term.constraints->points.host()[3 * instance + axis];
        const double g =
            problem.graph().nodes[static_cast<std::size_t>(nodes_[slot])][static_cast<int>(axis)];
        arms_.push_back(weight * (p - g));
      }
      arms_.push_back(weight);
    }
  }

  double factor() const { return scale_ * scale_; }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    std::array<double, max_stencil_inputs> u{};
    gather(parameters, u.data());
    term_.energy.equation.residual(u.data(), data_.data(), residuals);
    for (int row = 0; row < num_residuals(); ++row) residuals[row] *= scale_;
    if (jacobians == nullptr) return true;
    std::array<double, max_residuals * max_stencil_inputs> jacobian{};
    term_.energy.equation.jacobian(u.data(), data_.data(), jacobian.data());
    for (std::size_t slot = 0; slot < nodes_.size(); ++slot)
      if (jacobians[slot] != nullptr) scatter(jacobian.data(), slot, jacobians[slot]);
    return true;
  }

 private:
  bool is_constraint() const { return term_.constraints != nullptr; }

  void gather(double const* const* parameters, double* u) const {
    for (std::size_t slot = 0; slot < nodes_.size(); ++slot) {
      if (!is_constraint()) {
        std::copy_n(parameters[slot], affine_size, u + affine_size * slot);
        continue;
      }
      for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t axis = 0; axis < 3; ++axis)
          u[axis] += arms_[4 * slot + column] * parameters[slot][3 * column + axis];
    }
  }

  void scatter(const double* jacobian, std::size_t slot, double* out) const {
    const auto inputs = static_cast<std::size_t>(input_size(term_.energy.stencil));
    for (std::size_t row = 0; row < static_cast<std::size_t>(num_residuals()); ++row)
      for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t axis = 0; axis < 3; ++axis)
          out[affine_size * row + 3 * column + axis] =
              scale_ * (is_constraint() ? jacobian[inputs * row + axis] * arms_[4 * slot + column]
                                        : jacobian[inputs * row + affine_size * slot + 3 * column + axis]);
  }

  const Term& term_;
  std::vector<int> nodes_;
  double scale_ = 1;
  std::array<double, max_stencil_data> data_{};
  std::vector<double> arms_;  // per slot w (p - g), then w
};

/// The loss of an energy on residuals that carry the root of `factor` = weight * confidence.
class ScaledLoss : public ceres::LossFunction {
 public:
  ScaledLoss(const Loss& loss, double factor) : loss_(loss), factor_(factor) {}

  void Evaluate(double squared_norm, double* rho) const override {
    const double s = squared_norm / factor_;
    rho[0] = factor_ * loss_.value(s);
    rho[1] = loss_.weight(s);
    rho[2] = loss_.curvature(s) / factor_;
  }

 private:
  const Loss& loss_;
  double factor_;
};

/// The affine forms of a transform that is not free, among all: Ceres steps as the device does.
class TransformManifold : public ceres::Manifold {
 public:
  explicit TransformManifold(const NodeTransform& transform) : transform_(transform) {}

  int AmbientSize() const override { return affine_size; }
  int TangentSize() const override { return transform_.unknowns; }

  bool Plus(const double* form, const double* step, double* moved) const override {
    transform_.retract(form, step, moved);
    return true;
  }
  bool PlusJacobian(const double* form, double* jacobian) const override {
    for (std::size_t entry = 0; entry < affine_size; ++entry) {
      std::array<double, affine_size> one{};
      one[entry] = 1;
      transform_.pull_back(form, one.data(), jacobian + entry * static_cast<std::size_t>(TangentSize()));
    }
    return true;
  }

  // A minimisation asks for no differences of forms; whoever did would be told that there are none.
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }

 private:
  const NodeTransform& transform_;
};

struct Options {
  std::string linear_solver;
  int max_iterations;
  double tolerance;
  int threads;
};

class BoundCeres : public BoundSolver {
 public:
  BoundCeres(Problem& problem, const Options& options) : problem_(problem), options_(options) {}

  void solve() override {
    const auto& start = problem_.unknowns().host();
    std::vector<double> unknowns(start.begin(), start.end());
    ceres::Problem ceres_problem;
    add_nodes(ceres_problem, unknowns);
    for (const auto& term : problem_.terms()) add_term(ceres_problem, term, unknowns);

    ceres::Solver::Summary summary;
    const auto energies = minimise(ceres_problem, summary);
    record(summary, energies);
    if (!summary.IsSolutionUsable()) return;
    auto& solution = problem_.unknowns().write_host();
    std::transform(unknowns.begin(), unknowns.end(), solution.begin(),
                   [](double x) { return static_cast<float>(x); });
  }

  std::vector<SolverSummary> summaries() override { return summaries_; }

 private:
  /// Takes each node to the nearest form of the transform.
  void add_nodes(ceres::Problem& ceres_problem, std::vector<double>& unknowns) const {
    const NodeTransform& transform = problem_.transform();
    auto* manifold = transform.is_free() ? nullptr : new TransformManifold(transform);  // Ceres owns it
    for (int node = 0; node < problem_.node_count(); ++node) {
      double* form = unknowns.data() + affine_size * node;
      if (manifold != nullptr) {
        std::array<double, affine_size> nearest{};
        transform.nearest(form, nearest.data());
        std::copy(nearest.begin(), nearest.end(), form);
      }
      ceres_problem.AddParameterBlock(form, affine_size, manifold);
    }
  }

  void add_term(ceres::Problem& ceres_problem, const Term& term, std::vector<double>& unknowns) const {
    if (problem_.effective_weight(term) <= 0) return;
    for (std::size_t i = 0; i < instance_count(problem_, term); ++i) {
      if (term.constraints && term.constraints->confidence.host()[i] <= 0) continue;
      const auto nodes = coupled_nodes(problem_, term, i);
      std::vector<double*> blocks;
      for (const int node : nodes) blocks.push_back(unknowns.data() + affine_size * node);
      auto* cost = new InstanceCost(problem_, term, i, nodes, unknowns.data());
      auto* loss = term.energy.loss.is_robust() ? new ScaledLoss(term.energy.loss, cost->factor()) : nullptr;
      ceres_problem.AddResidualBlock(cost, loss, blocks);
    }
  }

  std::vector<double> minimise(ceres::Problem& ceres_problem, ceres::Solver::Summary& summary) const {
    ceres::Solver::Options options;
    ceres::StringToLinearSolverType(options_.linear_solver, &options.linear_solver_type);
    options.preconditioner_type = ceres::JACOBI;
    options.max_num_iterations = options_.max_iterations;
    options.function_tolerance = options_.tolerance;
    // Near nothing: an energy that has underflowed to 0 would be a failure, for no step lowers it.
    options.gradient_tolerance = 1e-100;
    options.parameter_tolerance = 0;
    options.num_threads = options_.threads;
    options.logging_type = ceres::SILENT;
    ceres::Solve(options, &ceres_problem, &summary);
    std::vector<double> energies;
    double energy = 2 * summary.initial_cost;  // Ceres halves the squares
    for (std::size_t i = 1; i < summary.iterations.size(); ++i) {
      const auto& iteration = summary.iterations[i];
      if (iteration.step_is_successful) energy = 2 * iteration.cost;
      energies.push_back(energy);
    }
    return energies;
  }

  void record(const ceres::Solver::Summary& summary, const std::vector<double>& energies) {
    SolverSummary made;
    made.solver = "ceres_lm";
    made.linear_solver = options_.linear_solver;
    made.initial_energy = 2 * summary.initial_cost;
    made.final_energy = 2 * summary.final_cost;
    made.energies = energies;
    made.iterations = static_cast<int>(energies.size());
    made.termination = summary.termination_type == ceres::CONVERGENCE ? "converged" : "max_iterations";
    if (!summary.IsSolutionUsable()) {
      made.termination = "failed";
      made.failure = "Ceres found no usable solution: " + summary.message;
    }
    made.time_ms["jacobian"] = 1e3 * summary.jacobian_evaluation_time_in_seconds;
    made.time_ms["solver"] = 1e3 * summary.linear_solver_time_in_seconds;
    made.time_ms["energy"] = 1e3 * summary.residual_evaluation_time_in_seconds;
    summaries_.push_back(std::move(made));
  }

  Problem& problem_;
  Options options_;
  std::vector<SolverSummary> summaries_;
};

class CeresLm : public Solver {
 public:
  explicit CeresLm(Options options) : options_(std::move(options)) {}
  std::unique_ptr<BoundSolver> bind(Problem& problem, Device&) const override {
    return std::make_unique<BoundCeres>(problem, options_);
  }

 private:
  Options options_;
};

}  // namespace

void register_ceres_lm(Registry& registry) {
  registry.add<Solver>(
      "ceres_lm", "Levenberg-Marquardt of Ceres on the host, double precision: the ground truth",
      {choice("linear_solver", {"sparse_normal_cholesky", "dense_normal_cholesky", "cgnr"},
              "sparse_normal_cholesky")
           .doc("Ceres' linear solver; cgnr with a Jacobi preconditioner"),
       integer("max_iterations", 100).range(1, 10000).doc("Iterations per solve at most"),
       real("tolerance", 1e-6).range(0, 1).doc("Ends the solve when the energy's relative change is below"),
       integer("threads", 2).range(1, 256).doc("Threads that evaluate residuals and Jacobians")},
      [](const Parameters& parameters, const Registry&) {
        return std::make_unique<CeresLm>(
            Options{parameters.text("linear_solver"), static_cast<int>(parameters.integer("max_iterations")),
                    parameters.real("tolerance"), static_cast<int>(parameters.integer("threads"))});
      });
}

}  // namespace pliant
