#include "experiments/tasks/task.h"

#include <fmt/format.h>

#include <algorithm>

#include "framework/core/error.h"

namespace pliant {
namespace {

/// Handles cannot give everything that an energy may ask for.
void check_energies(const Method& method, const std::string& place) {
  const auto is_pull = [](const Energy& energy) { return energy.stencil == Stencil::per_constraint; };
  if (std::none_of(method.energies.begin(), method.energies.end(), is_pull))
    throw ConfigError(place +
                      ": no energy draws the surface to the handles; expected 'constraint' among "
                      "the energies");
  for (const Energy& energy : method.energies) {
    if (energy.uses_features())
      throw ConfigError(
          fmt::format("{}: the energy '{}' needs a target to match features with; handles have none", place,
                      energy.equation.name));
  }
}

}  // namespace

std::unique_ptr<Task> make_task(const Parameters& experiment) {
  if (experiment.has("model")) return make_track_task();
  return experiment.sections("handles").empty() ? make_register_task() : make_edit_task();
}

ProgressSink labelled(const ProgressSink& progress, const std::string& label) {
  return [progress, label](const Progress& step) { progress({step.what, step.done, label + step.message}); };
}

Method make_method(const ExperimentRun& run, const Registry& registry) {
  Method method = make_method(run.values, registry);
  if (!run.values.sections("handles").empty()) check_energies(method, run.place);
  return method;
}

NamedHandles make_handles(const ExperimentRun& run, const Registry& registry) {
  NamedHandles handles;
  for (const auto& [name, section] : run.values.sections("handles"))
    handles.emplace_back(name, *registry.make<Handle>(section));
  return handles;
}

}  // namespace pliant
