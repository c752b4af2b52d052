#include <cstdio>

#include "experiments/runner/components.h"
#include "experiments/runner/experiment.h"
#include "experiments/tasks/workbench.h"
#include "framework/tracking/register_pair.h"

// Registers the pair of an experiment file and prints how far the first points went; fails when they did not.
int main() {
  pliant::Registry registry;
  pliant::register_everything(registry);
  const auto plan = pliant::plan_experiment({METHOD, {"data.amplitude=30"}, {}, {}}, registry);
  const pliant::Parameters& values = plan.runs.front().values;
  pliant::Workbench workbench(registry);
  const pliant::Method method = pliant::make_method(values, registry);
  const auto result = pliant::register_pair(workbench.pair(values), method, workbench.device(values), 1);
  const float moved = (result.points.front() - result.source.points.front()).norm();
  std::printf("%zu points, the first moved by %.2f mm\n", result.points.size(), moved);
  return moved > 1 ? 0 : 1;
}
