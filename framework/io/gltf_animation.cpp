#include "framework/io/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "framework/io/gltf_container.h"

namespace pliant {
namespace {

using Json = GltfDocument::Json;
using Numbers = GltfDocument::Numbers;

/// What a channel of an animation says it moves. `node`: in the file's list.
struct Moved {
  std::size_t node = 0;
  std::string path;
};

/// None where the channel moves no node, as those that extensions know.
std::optional<Moved> moved_by(const GltfDocument& document, const Json& channel) {
  const Json& target = document.at(channel, "target");
  if (document.find(target, "node") == nullptr) return std::nullopt;
  const std::size_t node = document.integer(target, "node");
  document.element("nodes", node);
  return Moved{node, document.text(target, "path")};
}

std::map<std::size_t, int> positions_of(const std::vector<GltfNode>& nodes) {
  std::map<std::size_t, int> positions;
  for (std::size_t i = 0; i < nodes.size(); ++i) positions[nodes[i].number] = static_cast<int>(i);
  return positions;
}

Track::Interpolation interpolation_of(const GltfDocument& document, const Json& sampler) {
  if (document.find(sampler, "interpolation") == nullptr) return Track::Interpolation::linear;
  const std::string name = document.text(sampler, "interpolation");
  if (name == "STEP") return Track::Interpolation::step;
  if (name == "LINEAR") return Track::Interpolation::linear;
  if (name != "CUBICSPLINE")
    document.fail(fmt::format("an animation is interpolated by {}, expected STEP, LINEAR or CUBICSPLINE",
                              shown_json(name)));
  return Track::Interpolation::cubic;
}

std::vector<double> read_times(const GltfDocument& document, const Json& sampler) {
  const std::vector<float> floats =
      document.reals(document.integer(sampler, "input"), "SCALAR", Numbers::floats);
  if (floats.empty()) document.fail("an animation has no keys");
  if (floats.front() < 0) document.fail(fmt::format("an animation has a key at {} s", floats.front()));
  for (std::size_t i = 1; i < floats.size(); ++i)
    if (floats[i] <= floats[i - 1])
      document.fail(fmt::format("the times of an animation do not increase: {} s after {} s", floats[i],
                                floats[i - 1]));
  return {floats.begin(), floats.end()};
}

/// Of the numbers at the keys of a track, not of its tangents.
void check_unit_length(const GltfDocument& document, const Track& track) {
  const bool is_cubic = track.interpolation == Track::Interpolation::cubic;
  for (std::size_t key = 0; key < track.times.size(); ++key) {
    const Eigen::Vector4d rotation(&track.values[4 * (is_cubic ? 3 * key + 1 : key)]);
    constexpr double kTolerance = 0.02;  // of rotations in 8 bits
    if (!(std::abs(rotation.norm() - 1) < kTolerance))
      document.fail(fmt::format("key {} of an animation is no unit quaternion", key));
  }
}

Track read_track(const GltfDocument& document, const Json& animation, const Json& channel,
                 const std::string& path, std::size_t width) {
  const auto& samplers = document.list(animation, "samplers");
  const std::size_t number = document.integer(channel, "sampler");
  if (number >= samplers.size())
    document.fail(fmt::format("an animation names sampler {} of {}", number, samplers.size()));
  const Json& sampler = samplers[number];
  Track track{interpolation_of(document, sampler), width, read_times(document, sampler), {}};
  const bool is_cubic = track.interpolation == Track::Interpolation::cubic;
  const bool may_be_normalised = path == "rotation" || path == "weights";
  const char* type = path == "weights" ? "SCALAR" : (path == "rotation" ? "VEC4" : "VEC3");
  const std::vector<float> values = document.reals(document.integer(sampler, "output"), type,
                                                   may_be_normalised ? Numbers::normalised : Numbers::floats);
  const std::size_t expected = track.times.size() * width * (is_cubic ? 3 : 1);
  if (values.size() != expected)
    document.fail(fmt::format("an animation has {} numbers of {} for {} keys, expected {}", values.size(),
                              path, track.times.size(), expected));
  track.values.assign(values.begin(), values.end());
  if (path == "rotation") check_unit_length(document, track);
  return track;
}

class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                  const std::map<std::size_t, std::vector<std::size_t>>& targets, double unit)
      : document_(document), nodes_(nodes), positions_(positions_of(nodes)), targets_(targets), unit_(unit) {}

  Animation read(const Json& description, std::size_t number) {
    animation_ = {};
    motion_of_.clear();
    animation_.name =
        document_.find(description, "name") != nullptr ? document_.text(description, "name") : "";
    if (animation_.name.empty()) animation_.name = fmt::format("animation{}", number);
    for (const Json& channel : document_.list(description, "channels")) add(description, channel);
    return std::move(animation_);
  }

 private:
  void add(const Json& description, const Json& channel) {
    const auto moved = moved_by(document_, channel);
    if (!moved || positions_.count(moved->node) == 0) return;
    if (moved->path == "weights") return add_weights(description, channel, moved->node);
    JointMotion& motion = motion_of(moved->node);
    if (moved->path == "translation") {
      motion.translations = read(description, channel, moved->path, 3);
      for (double& value : motion.translations->values) value *= unit_;
    } else if (moved->path == "rotation") {
      motion.rotations = read(description, channel, moved->path, 4);
    } else if (moved->path == "scale") {
      motion.scales = read(description, channel, moved->path, 3);
    } else {
      document_.fail(fmt::format("an animation changes {}, expected translation, rotation, scale or weights",
                                 shown_json(moved->path)));
    }
  }

  void add_weights(const Json& description, const Json& channel, std::size_t node) {
    const auto targets = targets_.find(node);
    if (targets == targets_.end() || targets->second.empty())
      document_.fail(
          fmt::format("an animation changes weights of node {}, which has no morph targets", node));
    animation_.weights.push_back(
        {targets->second, read(description, channel, "weights", targets->second.size())});
  }

  Track read(const Json& description, const Json& channel, const std::string& path, std::size_t width) {
    Track track = read_track(document_, description, channel, path, width);
    // A small file can name large data many times.
    constexpr std::size_t kMostNumbers = 20'000'000;
    total_ += track.times.size() + track.values.size();
    if (total_ > kMostNumbers) document_.fail("its animations have more keys than can be held");
    animation_.duration = std::max(animation_.duration, track.times.back());
    return track;
  }

  JointMotion& motion_of(std::size_t node) {
    const auto [entry, is_new] = motion_of_.try_emplace(node, animation_.joints.size());
    if (!is_new) return animation_.joints[entry->second];
    const int position = positions_.at(node);
    JointMotion motion = resting_motion(document_, nodes_[static_cast<std::size_t>(position)]);
    motion.joint = position;
    motion.translation *= unit_;
    animation_.joints.push_back(std::move(motion));
    return animation_.joints.back();
  }

  const GltfDocument& document_;
  const std::vector<GltfNode>& nodes_;
  std::map<std::size_t, int> positions_;
  const std::map<std::size_t, std::vector<std::size_t>>& targets_;
  double unit_;
  std::size_t total_ = 0;  // of numbers read
  Animation animation_;
  std::map<std::size_t, std::size_t> motion_of_;  // by node: which of the animation's
};

}  // namespace

std::vector<bool> moved_nodes(const GltfDocument& document, const std::vector<GltfNode>& nodes) {
  const std::map<std::size_t, int> positions = positions_of(nodes);
  std::vector<bool> moved(nodes.size(), false);
  for (const Json& animation : document.list(document.root(), "animations"))
    for (const Json& channel : document.list(animation, "channels")) {
      const auto what = moved_by(document, channel);
      if (!what || what->path == "weights" || positions.count(what->node) == 0) continue;
      moved[static_cast<std::size_t>(positions.at(what->node))] = true;
    }
  return moved;
}

std::vector<Animation> read_animations(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                                       const std::map<std::size_t, std::vector<std::size_t>>& targets,
                                       double unit) {
  AnimationReader reader(document, nodes, targets, unit);
  std::vector<Animation> animations;
  for (const Json& description : document.list(document.root(), "animations"))
    animations.push_back(reader.read(description, animations.size()));
  return animations;
}

}  // namespace pliant
