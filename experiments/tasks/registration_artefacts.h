#pragma once

#include "experiments/report/artefacts.h"
#include "experiments/tasks/measured.h"
#include "experiments/tasks/task.h"
#include "experiments/tasks/timing.h"
#include "framework/geometry/surface.h"
#include "framework/tracking/result.h"

namespace pliant {

/// How large the graph and the constraints were before the first outer iteration and in each.
struct GraphGrowth {
  std::vector<double> nodes;
  std::vector<double> constraints;
};

/// What the registration of a pair came to. `target`: the points of the pair's target.
RunArtefacts registration_artefacts(const ExperimentRun& run, const FramePair& pair,
                                    const SurfaceImage& target, const RegistrationResult& result,
                                    const Measured& measured, const GraphGrowth& growth,
                                    const Timing& timing);

}  // namespace pliant
