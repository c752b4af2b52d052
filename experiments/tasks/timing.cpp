#include "experiments/tasks/timing.h"

#include <utility>

namespace pliant {

using nlohmann::ordered_json;

ordered_json Timing::stages_json() const {
  ordered_json times = {{"total", total_ms}};
  for (const auto& [stage, milliseconds] : stages) times[stage] = milliseconds;
  return times;
}

ordered_json Timing::json() const {
  return {{"repeats", repeats},
          {"median_ms", total_ms},
          {"min_ms", min_ms},
          {"max_ms", max_ms},
          {"built_kernels", built_kernels}};
}

Table Timing::table() const {
  std::vector<std::pair<std::string, double>> longest_first(stages.begin(), stages.end());
  std::stable_sort(longest_first.begin(), longest_first.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  Table table{"Time in ms", {}, {}};
  for (const auto& [name, milliseconds] : longest_first) {
    table.rows.push_back({{name, fmt::format("{:.2f}", milliseconds)}});
    table.bars.push_back(milliseconds);
  }
  table.rows.push_back({{"total", fmt::format("{:.2f}", total_ms)}});
  return table;
}

std::string Timing::text() const {
  if (repeats == 1) return fmt::format("{:.0f}", total_ms);
  return fmt::format("{:.0f} ({:.0f} to {:.0f})", total_ms, min_ms, max_ms);
}

}  // namespace pliant
