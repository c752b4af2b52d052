#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "benchmarks/bench.h"
#include "benchmarks/tracked_images.h"
#include "benchmarks/tracking_frame.h"
#include "benchmarks/tracking_imaging.h"
#include "benchmarks/tracking_model.h"
#include "benchmarks/tracking_policies.h"

namespace pliant::bench {
namespace {

using nlohmann::ordered_json;

/// What the stages of a frame are: each room of the framework gives its own.
std::vector<StagePair> stages_of(Device& device, const TrackedImages& images) {
  std::vector<StagePair> stages;
  for (StagePair& stage : imaging_stages(device, images)) stages.push_back(std::move(stage));
  stages.push_back(icp_stage(device, images));
  for (StagePair& stage : model_stages(device, images)) stages.push_back(std::move(stage));
  return stages;
}

ordered_json row_of(const std::string& stage, double ours, double opencv) {
  return {
      {"stage", stage}, {"time_ms", ours}, {"opencv_time_ms", opencv}, {"ratio_to_opencv", ours / opencv}};
}

/// Each stage, and the whole frame; OpenCV has no tracker, so its stages stand for it, one after the other.
ordered_json measure(Device& device, const std::string& name, const TrackedImages& images,
                     const Options& options) {
  const auto stages = stages_of(device, images);
  const StagePair frame = whole_frame(device, images, [&stages] {
    for (const StagePair& stage : stages) stage.opencv();
  });
  Timings timings;
  const Repeats repeats{options.quick ? 3 : 15, options.quick ? 1 : 5};
  const auto key = [&](const StagePair& stage, const char* whose) {
    return fmt::format("{} {} {}", name, stage.stage, whose);
  };
  std::vector<StagePair> measured = stages;
  measured.push_back(frame);
  std::erase_if(measured, [&](const StagePair& stage) {
    return (name + " " + stage.stage).find(options.only) == std::string::npos;
  });
  if (measured.empty()) return ordered_json::array();
  for (const StagePair& stage : measured) {
    timings.add(key(stage, "ours"), repeats, stage.ours);
    timings.add(key(stage, "opencv"), repeats, stage.opencv);
  }
  const auto times = timings.run();
  auto rows = ordered_json::array();
  for (const StagePair& stage : measured)
    rows.push_back(row_of(stage.stage, times.at(key(stage, "ours")), times.at(key(stage, "opencv"))));
  return rows;
}

void print(const std::string& name, const ordered_json& rows) {
  for (const auto& row : rows)
    fmt::print("{:<7} {:<10} {:>8.2f} ms, OpenCV {:>8.2f} ms: {:>5.2f} of it\n", name,
               row["stage"].get<std::string>(), row["time_ms"].get<double>(),
               row["opencv_time_ms"].get<double>(), row["ratio_to_opencv"].get<double>());
}

}  // namespace

int run_tracking_mode(const Options& options) {
  Device device;
  ordered_json lists;
  for (const auto& [name, make] : {std::pair{"full", &room_images}, {"object", &head_images}}) {
    const TrackedImages images = make(device);
    lists[name] = measure(device, name, images, options);
    print(name, lists[name]);
  }
  lists["policies"] = measure_policies(device, options);
  write_json(options, lists);
  return 0;
}

}  // namespace pliant::bench
