#include "experiments/runner/result_json.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "experiments/runner/version.h"

namespace pliant {

using nlohmann::ordered_json;

ordered_json environment_json(const DeviceInfo& device, const ExperimentPlan& plan) {
  ordered_json libraries_json = ordered_json::object();
  for (const auto& [name, number] : libraries()) libraries_json[name] = number;
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {{"version", version()},
          {"commit", commit()},
          {"device", device.name},
          {"opencl_driver", fmt::format("{} {} ({})", device.platform, device.driver, device.version)},
          {"libraries", libraries_json},
          {"seed", plan.experiment.values.integer("seed")},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))}};
}

ordered_json result_json(const ExperimentPlan& plan, const DeviceInfo& device,
                         const ExperimentResult& result) {
  ordered_json runs = ordered_json::array();
  for (const auto& run : result.runs) runs.push_back(run.json);
  ordered_json json = {{"schema", 1},
                       {"experiment", plan.experiment.to_json()},
                       {"environment", environment_json(device, plan)},
                       {"runs", runs}};
  for (const auto& failed : result.failed)
    json["failed"].push_back({{"name", failed.name}, {"error", failed.message}});
  return json;
}

}  // namespace pliant
