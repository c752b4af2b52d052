#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/report/table.h"
#include "framework/core/stopwatch.h"
#include "framework/device/device.h"

namespace pliant {

/// How long the work of a run took.
struct Timing {
  int repeats = 1;  ///< how often it was timed; the next two are those of the median one
  double total_ms = 0;
  StageTimes stages;
  double min_ms = 0;
  double max_ms = 0;
  bool built_kernels = false;  ///< in the time that is told: a later run takes less

  nlohmann::ordered_json stages_json() const;
  nlohmann::ordered_json json() const;
  Table table() const;
  std::string text() const;  ///< milliseconds, of several runs with the least and the most
};

/// Makes a result with `make(label)`, or after one that does not count `repeats` of them, which differ only
/// in `total_ms` and `time_ms`.
template <class Make>
auto make_timed(Device& device, int repeats, Timing& timing, Make make) {
  struct Times {
    double total_ms;
    StageTimes stages;
  };
  device.measure_stages(true);
  int built = device.programs_built();
  auto result = make(repeats > 0 ? "warm-up, " : "");
  std::vector<Times> times{{result.total_ms, result.time_ms}};
  if (repeats > 0) {
    times.clear();
    built = device.programs_built();
    for (int i = 1; i <= repeats; ++i) {
      const auto again = make(fmt::format("{} of {}, ", i, repeats));
      times.push_back({again.total_ms, again.time_ms});
    }
  }
  device.measure_stages(false);
  std::sort(times.begin(), times.end(), [](const auto& a, const auto& b) { return a.total_ms < b.total_ms; });
  const Times& median = times[(times.size() - 1) / 2];
  timing = {static_cast<int>(times.size()), median.total_ms,       median.stages,
            times.front().total_ms,         times.back().total_ms, device.programs_built() > built};
  return result;
}

}  // namespace pliant
