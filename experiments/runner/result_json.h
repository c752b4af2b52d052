#pragma once

#include <nlohmann/json.hpp>

#include "experiments/runner/experiment.h"
#include "experiments/runner/runner.h"

namespace pliant {

/// What made the results: version, device, libraries, seed, date.
nlohmann::ordered_json environment_json(const DeviceInfo& device, const ExperimentPlan& plan);

/// All of the file of all runs' numbers.
nlohmann::ordered_json result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                                   const ExperimentResult& result);

}  // namespace pliant
