#include "benchmarks/tracking_policies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/datasets/frame_source.h"
#include "experiments/program/folders.h"
#include "experiments/runner/components.h"
#include "experiments/runner/experiment.h"
#include "framework/tracking/tracker.h"

namespace pliant::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t frames_read = 175;  // to the end of where all sequences are held deformed
constexpr int repetitions = 2;            // the first builds kernels

/// By the name of their files.
std::vector<std::string> sequences(bool is_quick) {
  if (is_quick) return {"bag", "smile"};
  return {"angry", "bag", "body", "cheeks", "cheeks_2", "kiss", "kiss_2", "open_mouth", "smile", "smile_2"};
}

/// The sequence by each policy.
std::vector<ExperimentRun> runs_of(const std::string& sequence, const Registry& registry) {
  const std::string text = fmt::format(
      "extends: methods/{1}.yaml\n"
      "runs:\n"
      "  rigid_only: {{extends: data/{0}.yaml, policy: rigid_only}}\n"
      "  adaptive: {{extends: data/{0}.yaml, policy: {{type: adaptive}}}}\n"
      "  adaptive_reintegration:\n"
      "    {{extends: data/{0}.yaml, policy: {{type: adaptive}}, update: {{type: reintegration, weight: "
      "255}}}}\n",
      sequence, sequence == "body" ? "tracked_body" : "tracked");
  return plan_experiment({ConfigText{text, "the policies", experiments_folder() / "chapter6"}, {}, {}},
                         registry)
      .runs;
}

std::vector<Frame> read_frames(FrameStream& stream) {
  CheckedStream checked(stream);
  std::vector<Frame> frames;
  while (frames.size() < frames_read) frames.push_back(checked.require("the rest of the sequence"));
  return frames;
}

/// What a sequence came to by a policy.
struct Measured {
  std::vector<double> frames_ms;  ///< the least of each
  int registered = 0;
  int lost = 0;
};

Measured measure(const TrackingMethod& method, const Rig& rig, const std::vector<Frame>& frames,
                 Device& device) {
  Measured measured{std::vector<double>(frames.size(), std::numeric_limits<double>::infinity())};
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    Tracker tracker(method, rig, device);
    measured.registered = measured.lost = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const FrameRecord record = tracker.track(frames[i]);
      measured.frames_ms[i] = std::min(measured.frames_ms[i], record.total_ms);
      measured.registered += is_registered(record) ? 1 : 0;
      measured.lost += record.state == FrameState::lost ? 1 : 0;
    }
  }
  return measured;
}

ordered_json row_of(const std::string& sequence, const std::string& policy, const Measured& measured) {
  double total = 0;
  for (const double time : measured.frames_ms) total += time;
  const auto frames = static_cast<double>(measured.frames_ms.size());
  return {{"sequence", sequence},
          {"policy", policy},
          {"frames", measured.frames_ms.size()},
          {"fps", 1000 * frames / total},
          {"slowest_frame_ms", *std::max_element(measured.frames_ms.begin(), measured.frames_ms.end())},
          {"registered", measured.registered / frames},
          {"lost", measured.lost}};
}

void print(const ordered_json& row) {
  fmt::print("{:<10} {:<19} {:>6.1f} frames a second, {:>6.1f} ms at most, {:>3.0f} % registered, {} lost\n",
             row["sequence"].get<std::string>(), row["policy"].get<std::string>(), row["fps"].get<double>(),
             row["slowest_frame_ms"].get<double>(), 100 * row["registered"].get<double>(),
             row["lost"].get<int>());
  std::fflush(stdout);  // who waits sees each as it comes
}

}  // namespace

ordered_json measure_policies(Device& device, const Options& options) {
  Registry registry;
  register_everything(registry);
  auto rows = ordered_json::array();
  for (const std::string& sequence : sequences(options.quick)) {
    auto runs = runs_of(sequence, registry);
    std::erase_if(runs, [&](const ExperimentRun& run) {
      return fmt::format("policies {} {}", sequence, run.name).find(options.only) == std::string::npos;
    });
    if (runs.empty()) continue;
    const auto stream = registry.make<FrameSource>(runs.front().values.section("data"))->open(device, 1);
    const std::vector<Frame> frames = read_frames(*stream);
    for (const ExperimentRun& run : runs) {
      const TrackingMethod method = make_tracking_method(run.values, registry);
      rows.push_back(row_of(sequence, run.name, measure(method, stream->rig(), frames, device)));
      print(rows.back());
    }
  }
  return rows;
}

}  // namespace pliant::bench
