#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "experiments/report/table.h"
#include "framework/core/log.h"
#include "framework/evaluation/metrics.h"
#include "framework/tracking/result.h"

namespace pliant {

/// How far a registered source lay from its target, measured once for all who tell of it.
struct Measured {
  struct Stage {
    std::vector<float> nearest;  ///< per source point, mm to the nearest target point
    Metrics metrics;
  };
  Stage initial;  ///< before anything
  Stage aligned;  ///< after the initial alignment
  Stage final;    ///< at the end
};

Measured measure(const Evaluation& evaluation, const RegistrationResult& result,
                 const ProgressSink& progress);

nlohmann::ordered_json metrics_json(const Metrics& metrics);
Table metrics_table(const Measured& measured);

}  // namespace pliant
