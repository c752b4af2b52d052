#include "solvers/gauss_newton/automatic.h"

#include <utility>

#include "solvers/gauss_newton/linear_solver.h"
#include "solvers/gauss_newton/structured.h"

namespace pliant {
namespace {

/// Another course that also says why it was taken.
class ChosenCourse : public Course {
 public:
  ChosenCourse(std::unique_ptr<Course> course, std::string reason)
      : course_(std::move(course)), reason_(std::move(reason)) {}
  void enqueue(const cl::Buffer& status) override { course_->enqueue(status); }
  std::string description() const override { return course_->description() + ": " + reason_; }

 private:
  std::unique_ptr<Course> course_;
  std::string reason_;
};

class Automatic : public LinearSolver {
 public:
  Automatic(std::unique_ptr<LinearSolver> structured, std::unique_ptr<LinearSolver> general)
      : structured_(std::move(structured)), general_(std::move(general)) {}

  std::unique_ptr<Course> bind(Problem& problem, Device& device,
                               const CourseOptions& options) const override {
    const auto obstacle = structured_obstacle(problem);
    const auto& chosen = obstacle.empty() ? structured_ : general_;
    return std::make_unique<ChosenCourse>(
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
