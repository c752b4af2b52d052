#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/report/report.h"
#include "experiments/runner/experiment.h"

namespace pliant {

/// What made the results: version, commit, device, OpenCL driver, libraries, seed and date.
nlohmann::ordered_json environment_json(const DeviceInfo& device, const ExperimentPlan& plan);

/// One entry of `runs` in result.json.
nlohmann::ordered_json run_json(const RunRecord& run);

nlohmann::ordered_json run_json(const EditRecord& run);

/// All of result.json.
nlohmann::ordered_json result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                                   const std::vector<RunRecord>& runs);
nlohmann::ordered_json result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                                   const std::vector<EditRecord>& runs);

/// Makes or replaces a file. Throws NumericalError naming the key of a number that is not finite (JSON knows
/// none), DataError when the file cannot be written.
void write_json(const std::string& path, const nlohmann::ordered_json& json);

}  // namespace pliant
