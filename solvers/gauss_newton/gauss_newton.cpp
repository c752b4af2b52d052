#include "solvers/gauss_newton/gauss_newton.h"

#include <array>
#include <bit>

#include "framework/core/error.h"
#include "framework/problem/solver.h"
#include "solvers/gauss_newton/gauss_newton.cl.embed.h"
#include "solvers/gauss_newton/linear_solver.h"

namespace pliant {
namespace {

constexpr int most_iterations = 200;
constexpr std::size_t status_words = status_energies + most_iterations;

struct Options {
  int max_iterations;
  float tolerance;
  float damping;
};

class BoundGaussNewton : public BoundSolver {
 public:
  BoundGaussNewton(Problem& problem, Device& device, const LinearSolver& linear_solver,
                   const Options& options)
      : problem_(problem),
        device_(device),
        options_(options),
        linear_solver_name_(linear_solver.name()),
        equations_(device, problem),
        linear_solver_(linear_solver.bind(equations_)),
        trial_(device.allocate(sizeof(float) * problem.unknowns().size())) {}

  void solve() override {
    auto begin = kernel("begin");
    const auto status = device_.allocate(sizeof(cl_int) * status_words);
    device_.fill_zero(status, sizeof(cl_int) * status_words);
    equations_.sum_energy(problem_.unknowns().device(device_), status);
    device_.run("energy", begin, 1, 1, status, equations_.energy_partials(),
                equations_.energy_partial_count(), options_.damping);
    for (int i = 0; i < options_.max_iterations; ++i) iterate(status);
    records_.push_back(status);
  }

  std::vector<SolverSummary> summaries() override {
    std::vector<SolverSummary> all;
    for (const auto& record : records_) all.push_back(summary_of(record));
    return all;
  }

 private:
  cl::Kernel kernel(const char* name) {
    return device_.kernel(embedded::solvers_gauss_newton_gauss_newton_cl, name);
  }

  void iterate(const cl::Buffer& status) {
    auto try_step = kernel("try_step");
    auto decide = kernel("decide");
    auto accept = kernel("accept");
    auto end_iteration = kernel("end_iteration");
    const auto count = problem_.unknowns().size();
    equations_.assemble(status);
    linear_solver_->solve(status);
    device_.run("solver", try_step, count, 64, status, static_cast<cl_int>(count),
                problem_.unknowns().device(device_), linear_solver_->step(), trial_);
    equations_.sum_energy(trial_, status);
    device_.run("energy", decide, 1, 1, status, equations_.energy_partials(),
                equations_.energy_partial_count(), options_.max_iterations, options_.tolerance,
                options_.damping);
    device_.run("solver", accept, count, 64, status, static_cast<cl_int>(count), trial_,
                problem_.unknowns().write_device(device_));
    device_.run("solver", end_iteration, 1, 1, status);
  }

  SolverSummary summary_of(const cl::Buffer& record) const {
    std::array<cl_int, status_words> words{};
    device_.read(record, words.data(), sizeof(words));
    const auto number = [&](std::size_t word) {
      return static_cast<double>(std::bit_cast<float>(words[word]));
    };
    SolverSummary summary;
    summary.solver = "gauss_newton";
    summary.linear_solver = linear_solver_name_;
    summary.initial_energy = number(status_initial_energy);
    summary.final_energy = number(status_energy);
    summary.iterations = words[status_iterations];
    for (std::size_t i = 0; i < static_cast<std::size_t>(summary.iterations); ++i)
      summary.energies.push_back(number(status_energies + i));
    constexpr std::array<const char*, 5> names{"max_iterations", "converged", "max_iterations", "no_decrease",
                                               "failed"};
    summary.termination = names.at(static_cast<std::size_t>(words[status_termination]));
    if (summary.termination == "failed")
      throw NumericalError("the energy is not finite at the start of a solve");
    return summary;
  }

  Problem& problem_;
  Device& device_;
  Options options_;
  std::string linear_solver_name_;
  NormalEquations equations_;
  std::unique_ptr<BoundLinearSolver> linear_solver_;
  cl::Buffer trial_;
  std::vector<cl::Buffer> records_;
};

class GaussNewton : public Solver {
 public:
  GaussNewton(std::unique_ptr<LinearSolver> linear_solver, const Options& options)
      : linear_solver_(std::move(linear_solver)), options_(options) {}
  std::unique_ptr<BoundSolver> bind(Problem& problem, Device& device) const override {
    return std::make_unique<BoundGaussNewton>(problem, device, *linear_solver_, options_);
  }

 private:
  std::unique_ptr<LinearSolver> linear_solver_;
  Options options_;
};

}  // namespace

void register_gauss_newton(Registry& registry) {
  registry.add<Solver>(
      "gauss_newton", "Damped Gauss-Newton on the device, single precision [thesis 4.6]",
      {integer("max_iterations", 30).range(1, most_iterations).doc("Iterations per solve at most"),
       real("tolerance", 1e-6).range(0, 1).doc("Ends the solve when the energy's relative change is below"),
       real("damping", 1e-6).range(0, 1).doc("Least Levenberg factor of the diagonal of J^T J"),
       component("linear_solver", "linear_solver", "dense_cholesky").doc("Solves for the step")},
      [](const Parameters& parameters, const Registry& components) {
        const Options options{static_cast<int>(parameters.integer("max_iterations")),
                              static_cast<float>(parameters.real("tolerance")),
                              static_cast<float>(parameters.real("damping"))};
        return std::make_unique<GaussNewton>(
            components.make<LinearSolver>(parameters.section("linear_solver")), options);
      });
}

}  // namespace pliant
