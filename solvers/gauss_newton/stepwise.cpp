#include "solvers/gauss_newton/stepwise.h"

#include "framework/problem/equation_source.h"
#include "solvers/gauss_newton/reductions.h"
#include "solvers/gauss_newton/stepwise.cl.embed.h"

namespace pliant {
namespace {

class StepwiseMinimiser : public Minimiser {
 public:
  StepwiseMinimiser(Problem& problem, Device& device, const MinimiserOptions& options,
                    std::string linear_solver, const MakeStepSolver& make)
      : problem_(problem),
        device_(device),
        options_(options),
        linear_solver_(std::move(linear_solver)),
        equations_(device, problem),
        step_solver_(make(equations_)),
        trial_(device.allocate(sizeof(float) * problem.unknowns().size())) {}

  void enqueue(const Buffer& status) override {
    auto begin = kernel("begin");
    if (!problem_.transform().is_free()) start_at_nearest(status);
    equations_.sum_energy(problem_.unknowns().device(device_), status);
    device_.run("energy", begin, 1, 1, status, equations_.energy_partials(),
                equations_.energy_partial_count(), options_.damping);
    for (int i = 0; i < options_.max_iterations && (i == 0 || !has_ended(device_, status)); ++i)
      iterate(status);
  }

  std::string description() const override { return linear_solver_; }

 private:
  cl::Kernel kernel(const char* name) {
    static const std::string source = with_reductions(embedded::solvers_gauss_newton_stepwise_cl);
    return device_.kernel(source, name);
  }

  cl::Kernel transform_kernel(const char* name) {
    return device_.kernel(transform_source(problem_.transform(), equations_.stride()), name);
  }

  void start_at_nearest(const Buffer& status) {
    auto take_nearest = transform_kernel("take_nearest");
    const auto nodes = problem_.node_count();
    device_.run("solver", take_nearest, static_cast<std::size_t>(nodes), 16, status, nodes,
                problem_.unknowns().write_device(device_));
  }

  void try_step(const Buffer& status) {
    const bool adds = problem_.transform().is_free();
    auto move = adds ? kernel("try_step") : transform_kernel("retract");
    const auto count = adds ? static_cast<cl_int>(problem_.unknowns().size()) : problem_.node_count();
    device_.run("solver", move, static_cast<std::size_t>(count), adds ? 64 : 16, status, count,
                problem_.unknowns().device(device_), step_solver_->step(), trial_);
  }

  void iterate(const Buffer& status) {
    auto decide = kernel("decide");
    auto accept = kernel("accept");
    auto end_iteration = kernel("end_iteration");
    const auto count = problem_.unknowns().size();
    equations_.assemble(status);
    step_solver_->solve(status);
    try_step(status);
    equations_.sum_energy(trial_, status);
    device_.run("energy", decide, 1, 1, status, equations_.energy_partials(),
                equations_.energy_partial_count(), options_.max_iterations, options_.tolerance,
                options_.damping);
    device_.run("solver", accept, count, 64, status, static_cast<cl_int>(count), trial_,
                problem_.unknowns().write_device(device_));
    device_.run("solver", end_iteration, 1, 1, status);
  }

  Problem& problem_;
  Device& device_;
  MinimiserOptions options_;
  std::string linear_solver_;
  NormalEquations equations_;
  std::unique_ptr<StepSolver> step_solver_;
  Buffer trial_;
};

}  // namespace

std::unique_ptr<Minimiser> make_stepwise_minimiser(Problem& problem, Device& device,
                                                   const MinimiserOptions& options,
                                                   const std::string& linear_solver,
                                                   const MakeStepSolver& make) {
  return std::make_unique<StepwiseMinimiser>(problem, device, options, linear_solver, make);
}

}  // namespace pliant
