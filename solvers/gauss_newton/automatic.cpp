#include "solvers/gauss_newton/automatic.h"

#include <utility>

#include "solvers/gauss_newton/linear_solver.h"
#include "solvers/gauss_newton/structured.h"

namespace pliant {
namespace {

/// Another minimiser that also says why it was taken.
class ChosenMinimiser : public Minimiser {
 public:
  ChosenMinimiser(std::unique_ptr<Minimiser> minimiser, std::string reason)
      : minimiser_(std::move(minimiser)), reason_(std::move(reason)) {}
  void enqueue(const Buffer& status) override { minimiser_->enqueue(status); }
  std::string description() const override { return minimiser_->description() + ": " + reason_; }

 private:
  std::unique_ptr<Minimiser> minimiser_;
  std::string reason_;
};

class Automatic : public LinearSolver {
 public:
  Automatic(std::unique_ptr<LinearSolver> structured, std::unique_ptr<LinearSolver> general)
      : structured_(std::move(structured)), general_(std::move(general)) {}

  std::unique_ptr<Minimiser> bind(Problem& problem, Device& device,
                                  const MinimiserOptions& options) const override {
    const auto obstacle = structured_obstacle(problem);
    const auto& chosen = obstacle.empty() ? structured_ : general_;
    return std::make_unique<ChosenMinimiser>(
        chosen->bind(problem, device, options),
        obstacle.empty() ? "no energy couples the axes of neighbouring nodes" : obstacle);
  }

 private:
  std::unique_ptr<LinearSolver> structured_;
  std::unique_ptr<LinearSolver> general_;
};

}  // namespace

void register_automatic(Registry& registry) {
  registry.add<LinearSolver>("automatic", "The fastest of the others for the problem at hand", {},
                             [](const Parameters&, const Registry& components) {
                               return std::make_unique<Automatic>(
                                   components.make<LinearSolver>(Parameters("structured", {})),
                                   components.make<LinearSolver>(Parameters("block_pcg", {})));
                             });
}

}  // namespace pliant
