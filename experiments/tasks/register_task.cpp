#include <algorithm>
#include <memory>
#include <utility>

#include "experiments/tasks/drawings.h"
#include "experiments/tasks/registration_artefacts.h"
#include "experiments/tasks/registration_view.h"
#include "framework/imaging/depth_map.h"
#include "framework/tracking/register_pair.h"

namespace pliant {
namespace {

/// Tells of each iteration, and keeps how large graph and constraints were in it.
Observer watching(const ProgressSink& progress, const std::string& label, const std::string& name,
                  const Method& method, GraphGrowth& growth) {
  const Observer tell = telling(labelled(progress, label), name, method.stopping.max_iterations);
  return [&growth, tell](const IterationView& view) {
    const auto nodes = static_cast<double>(view.graph.nodes.size());
    const auto constraints = static_cast<double>(view.constraints.size());
    // One that fails is told under the number of the one before.
    growth.nodes.resize(static_cast<std::size_t>(view.number) + 1, nodes);
    growth.constraints.resize(static_cast<std::size_t>(view.number) + 1, constraints);
    tell(view);
  };
}

/// Stands in for the view of a run.
const Picture& picture_of_errors(const RunArtefacts& made) {
  return *std::find_if(made.pictures.begin(), made.pictures.end(),
                       [](const Picture& picture) { return picture.name() == "error_final"; });
}

class RegisterTask : public Task {
 public:
  ArtefactNames names() const override {
    return {{"depth_source", "depth_target", "error_initial", "error_aligned", "error_final", "graph"},
            {"source", "target", "registered"},
            true};
  }

  std::vector<std::string> check(const ExperimentRun& run, Workbench& workbench) const override {
    make_method(run, workbench.registry());
    workbench.device(run.values);
    return workbench.pair(run.values).warnings;
  }

  RunArtefacts make(const ExperimentRun& run, Workbench& workbench, const Making& making) const override {
    const FramePair& pair = workbench.pair(run.values);
    const auto method_of_run = std::make_shared<const Method>(make_method(run, workbench.registry()));
    const Method& method = *method_of_run;
    const auto seed = static_cast<std::uint64_t>(run.values.integer("seed"));
    Device& device = workbench.device(run.values);
    Timing timing;
    GraphGrowth growth;
    RegistrationResult result = told_with_place(run.place, pair, [&] {
      return make_timed(device, making.repeats, timing, [&](const std::string& label) {
        return register_pair(pair, method, device, seed,
                             watching(making.progress, label, pair.name, method, growth));
      });
    });
    const SurfaceImage target = make_surface_image(device, pair.target, pair.camera);
    const Evaluation evaluation(pair, workbench.truth(run.values), result.source, target);
    const Measured measured = measure(evaluation, result, making.progress);
    RunArtefacts made = registration_artefacts(run, pair, target, result, measured, growth, timing);
    made.view.emplace([&pair, &truth = workbench.truth(run.values), &device, method_of_run, seed,
                       progress = making.progress, target, result = std::move(result),
                       picture = picture_of_errors(made)] {
      progress({"", 1, "registering once more, watched"});
      return gather_view({pair, truth, *method_of_run, device, seed, result, target, picture});
    });
    return made;
  }
};

}  // namespace

std::unique_ptr<Task> make_register_task() { return std::make_unique<RegisterTask>(); }

}  // namespace pliant
