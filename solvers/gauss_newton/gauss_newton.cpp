#include "solvers/gauss_newton/gauss_newton.h"

#include <array>
#include <bit>

#include "framework/problem/solver.h"
#include "solvers/gauss_newton/linear_solver.h"

namespace pliant {
namespace {

class BoundGaussNewton : public BoundSolver {
 public:
  BoundGaussNewton(Problem& problem, Device& device, const LinearSolver& linear_solver,
                   const MinimiserOptions& options)
      : device_(device), minimiser_(linear_solver.bind(problem, device, options)) {}

  void solve() override {
    collect();
    const Buffer& status = record_.write_device(device_);
    device_.fill_zero(status, sizeof(cl_int) * record_.size());
    minimiser_->enqueue(status);
    record_.fetch();
    is_pending_ = true;
  }

  std::vector<SolverSummary> summaries() override {
    collect();
    return summaries_;
  }

 private:
  /// Waits for the last solve, if nobody has yet.
  void collect() {
    if (is_pending_) summaries_.push_back(summary_of(record_.host()));
    is_pending_ = false;
  }

  SolverSummary summary_of(const std::vector<cl_int>& words) const {
    const auto number = [&](std::size_t word) {
      return static_cast<double>(std::bit_cast<float>(words[word]));
    };
    SolverSummary summary;
    summary.solver = "gauss_newton";
    summary.linear_solver = minimiser_->description();
    summary.initial_energy = number(status_initial_energy);
    summary.final_energy = number(status_energy);
    summary.iterations = words[status_iterations];
    summary.linear_iterations = words[status_linear_iterations];
    for (std::size_t i = 0; i < static_cast<std::size_t>(summary.iterations); ++i)
      summary.energies.push_back(number(status_energies + i));
    constexpr std::array<const char*, 5> names{"", "converged", "max_iterations", "no_decrease", "failed"};
    summary.termination = names.at(static_cast<std::size_t>(words[status_termination]));
    if (words[status_termination] == termination_not_finite)
      summary.failure = "the energy is not finite at the start of a solve";
    return summary;
  }

  Device& device_;
  std::unique_ptr<Minimiser> minimiser_;
  Array<cl_int> record_{status_words};
  bool is_pending_ = false;
  std::vector<SolverSummary> summaries_;
};

class GaussNewton : public Solver {
 public:
  GaussNewton(std::unique_ptr<LinearSolver> linear_solver, const MinimiserOptions& options)
      : linear_solver_(std::move(linear_solver)), options_(options) {}
  std::unique_ptr<BoundSolver> bind(Problem& problem, Device& device) const override {
    return std::make_unique<BoundGaussNewton>(problem, device, *linear_solver_, options_);
  }

 private:
  std::unique_ptr<LinearSolver> linear_solver_;
  MinimiserOptions options_;
};

}  // namespace

void register_gauss_newton(Registry& registry) {
  registry.add<Solver>(
      "gauss_newton", "Damped Gauss-Newton on the device, single precision [thesis 4.6]",
      {integer("max_iterations", 30).range(1, most_iterations).doc("Iterations per solve at most"),
       real("tolerance", 1e-6).range(0, 1).doc("Ends the solve when the energy's relative change is below"),
       real("damping", 1e-6).range(0, 1).doc("Least Levenberg factor of the diagonal of J^T J"),
       component("linear_solver", "linear_solver", "automatic").doc("Solves for the step")},
      [](const Parameters& parameters, const Registry& components) {
        const MinimiserOptions options{static_cast<int>(parameters.integer("max_iterations")),
                                       static_cast<float>(parameters.real("tolerance")),
                                       static_cast<float>(parameters.real("damping"))};
        return std::make_unique<GaussNewton>(
            components.make<LinearSolver>(parameters.section("linear_solver")), options);
      });
}

}  // namespace pliant
