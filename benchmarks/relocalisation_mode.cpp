#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "benchmarks/bench.h"
#include "experiments/datasets/frame_source.h"
#include "experiments/runner/components.h"
#include "framework/config/config.h"
#include "framework/core/angle.h"
#include "framework/tracking/tracker.h"

namespace pliant::bench {
namespace {

using nlohmann::ordered_json;

constexpr double distance = 700;  // mm, of the head from the camera
constexpr int smooth_frames = 60;
constexpr int held = 2;           // frames in each place
constexpr double jump_way = 100;  // mm
constexpr double jump_turn = 30;  // degrees
constexpr double near_way = 10;   // mm
constexpr double near_turn = 3;   // degrees
const Eigen::Vector3d middle(0, 0, distance);

/// The same with any standard library.
double draw(std::mt19937_64& random) { return 2 * std::ldexp(static_cast<double>(random() >> 11), -53) - 1; }

Eigen::Vector3d draw_direction(std::mt19937_64& random) {
  for (;;) {
    Eigen::Vector3d inside;
    for (double& value : inside) value = draw(random);
    if (inside.norm() > 0.1 && inside.norm() < 1) return inside.normalized();
  }
}

/// A head that leaps out of the middle: about a random axis through its own, in a random direction.
Eigen::Isometry3d draw_jump(std::mt19937_64& random) {
  const Eigen::Vector3d way = jump_way * draw_direction(random);
  return Eigen::Translation3d(middle + way) * Eigen::AngleAxisd(jump_turn * degree, draw_direction(random)) *
         Eigen::Translation3d(-middle);
}

/// The camera before which the head stands still as it moves before one that does.
std::string camera_key(int frame, const Eigen::Isometry3d& motion) {
  const Eigen::Isometry3d camera = motion.inverse();
  const Eigen::Vector3d turns = camera.linear().eulerAngles(2, 1, 0) / degree;  // z, y, x
  const Eigen::Vector3d& shift = camera.translation();
  return fmt::format("f{0}: {{at: {1}, camera: {{shift: [{2}, {3}, {4}], rotation: [{5}, {6}, {7}]}}}}, ",
                     frame, (frame - 1) / frame_rate, shift.x(), shift.y(), shift.z(), turns[2], turns[1],
                     turns[0]);
}

/// Around the head for its model, then to and fro between the middle and places it leaps to.
std::string keys(int jumps) {
  std::string text =
      "a: {at: 0}, b: {at: 0.5, camera: {look_from: [-260, 20, 40]}}, "
      "c: {at: 1, camera: {look_from: [-20, -200, 40]}}, d: {at: 1.5, camera: {look_from: [260, 20, 40]}}, "
      "e: {at: 1.8, camera: {look_from: [30, 160, 20]}}, ";
  std::mt19937_64 random(1);
  int frame = smooth_frames;
  text += camera_key(frame, Eigen::Isometry3d::Identity());
  for (int jump = 0; jump < jumps; ++jump) {
    const Eigen::Isometry3d there = draw_jump(random);
    for (int i = 0; i < held; ++i) text += camera_key(++frame, there);
    for (int i = 0; i < held; ++i) text += camera_key(++frame, Eigen::Isometry3d::Identity());
  }
  return text.substr(0, text.size() - 2);
}

constexpr const char* without_color = "none";  // as a texture

Parameters read_experiment(const std::string& relocalizer, const std::string& texture, int jumps,
                           const Registry& registry) {
  const std::string text = fmt::format(
      "data: {{type: head, distance: {}, texture: {}, sensor: {{axial: 1, quantisation: 1, lateral: 1, "
      "grazing: 80}}, keys: {{{}}}}}\n"
      "acquisition: {{depth_cut: 1300}}\nsegmentation: {{type: bounding_box, margin: 8}}\n"
      "model: {{type: tsdf, volume: fitted}}\nrelocalizer: {}\n",
      distance, texture == without_color ? "rich" : texture, keys(jumps), relocalizer);
  std::vector<Parameter> rows = tracking_rows();
  rows.push_back(component("data", FrameSource::kind));
  return load_experiment({ConfigText{text, "the head that leaps", {}}, {}, {}}, ParameterTable(rows),
                         registry)
      .values;
}

/// Of the frames of all leaps.
struct Found {
  int jumps = 0;
  int at_once = 0;  ///< near the truth in the first frame of its place
  int later = 0;    ///< and in the last
  int back = 0;     ///< leaps back to the middle, near the truth in the last frame there
  int wrong = 0;    ///< frames that count as tracked far from the truth
  int relocalised = 0;
  double relocalisation_ms = 0;  ///< sum over the frames in which it was asked
  int asked = 0;
  double keyframe_ms = 0;  ///< the most
};

bool is_near(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth) {
  return (found * middle - truth * middle).norm() < near_way &&
         Eigen::AngleAxisd(found.linear() * truth.linear().transpose()).angle() < near_turn * degree;
}

void add(const FrameRecord& record, bool is_right, Found& found) {
  if (has_pose(record.state) && !is_right) ++found.wrong;
  if (record.relocalized) ++found.relocalised;
  const auto time = [&](const char* stage) {
    const auto at = record.time_ms.find(stage);
    return at == record.time_ms.end() ? 0.0 : at->second;
  };
  found.keyframe_ms = std::max(found.keyframe_ms, time("keyframe"));
  if (time("relocalisation") > 0) ++found.asked;
  found.relocalisation_ms += time("relocalisation");
  const int after = record.number - smooth_frames - 1;
  if (after < 0) return;
  const int place = after / held;
  const bool is_there = place % 2 == 0;
  const bool is_last = after % held == held - 1;
  if (is_there && is_last) ++found.jumps;
  if (!has_pose(record.state) || !is_right) return;
  if (is_there && after % held == 0) ++found.at_once;
  if (is_last) ++(is_there ? found.later : found.back);
}

Found measure(const std::string& relocalizer, const std::string& texture, int jumps, const Registry& registry,
              Device& device) {
  const Parameters experiment = read_experiment(relocalizer, texture, jumps, registry);
  const TrackingMethod method = make_tracking_method(experiment, registry);
  const auto stream = registry.make<FrameSource>(experiment.section("data"))->open(device, 1);
  Tracker tracker(method, stream->rig(), device);
  CheckedStream frames(*stream);
  Found found;
  while (auto frame = frames.next()) {
    if (texture == without_color) frame->color = {};
    const FrameRecord record = tracker.track(*frame);
    // The first frame's camera is the model's frame.
    const Eigen::Isometry3d truth = stream->camera_pose(record.number)->inverse() * *stream->camera_pose(1);
    add(record, is_near(record.camera_from_model, truth), found);
  }
  return found;
}

ordered_json row_of(const std::string& relocalizer, const std::string& texture, const Found& found) {
  return {{"relocalizer", relocalizer},
          {"texture", texture},
          {"jumps", found.jumps},
          {"found_at_once", found.at_once},
          {"found", found.later},
          {"found_back", found.back},
          {"wrong_frames", found.wrong},
          {"relocalised_frames", found.relocalised},
          {"relocalisation_ms", found.relocalisation_ms / std::max(found.asked, 1)},
          {"greatest_keyframe_ms", found.keyframe_ms}};
}

}  // namespace

int run_relocalisation_mode(const Options& options) {
  Device device;
  Registry registry;
  register_everything(registry);
  auto rows = ordered_json::array();
  for (const ComponentInfo* relocalizer : registry.components(RelocalizerKind::kind)) {
    for (const std::string texture : {"rich", "face", "skin", without_color}) {
      if ((relocalizer->name + " " + texture).find(options.only) == std::string::npos) continue;
      rows.push_back(row_of(relocalizer->name, texture,
                            measure(relocalizer->name, texture, options.quick ? 5 : 200, registry, device)));
      const auto& row = rows.back();
      fmt::print(
          "{:<12} {:<5} {:>3} of {} leaps found, {} in the first frame, {} back; {} frames wrong; {:.1f} ms "
          "a frame relocalised, {:.1f} ms a keyframe at most\n",
          relocalizer->name, texture, row["found"].get<int>(), row["jumps"].get<int>(),
          row["found_at_once"].get<int>(), row["found_back"].get<int>(), row["wrong_frames"].get<int>(),
          row["relocalisation_ms"].get<double>(), row["greatest_keyframe_ms"].get<double>());
    }
  }
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
