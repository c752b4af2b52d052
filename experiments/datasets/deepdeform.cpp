#include "experiments/datasets/deepdeform.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "experiments/datasets/numbered_files.h"
#include "experiments/datasets/sequence.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr double frames_a_second = 30;  // of the Structure Sensor that recorded them

/// The source and the target of a pair, by the numbers of their files.
struct PairNumbers {
  std::int64_t source = 0;
  std::int64_t target = 0;
};

std::optional<PairNumbers> pair_numbers(const Parameters& section) {
  if (!section.has("source") && !section.has("target")) return std::nullopt;
  if (!section.has("source") || !section.has("target"))
    throw ConfigError(fmt::format("{}: a pair has both 'source' and 'target'; '{}' is missing",
                                  section.place(), section.has("source") ? "target" : "source"));
  const PairNumbers pair{section.integer("source"), section.integer("target")};
  if (pair.source == pair.target)
    throw ConfigError(fmt::format("{}: 'source' and 'target' are both {}", section.place(), pair.source));
  return pair;
}

/// The files of a sequence's folder by their names without what all have.
struct SequenceFiles {
  explicit SequenceFiles(const std::string& sequence)
      : folder(sequence),
        depth(matching_files(sequence, "depth/*.png")),
        color(matching_files(sequence, "color/*.jpg")),
        masks(matching_files(sequence, "mask/*.png")),
        flows(matching_files(sequence, "scene_flow/*.sflow")),
        optical_flows(matching_files(sequence, "optical_flow/*.oflow")),
        visible(matching_files(sequence, "visible/*.png")) {
    color.merge(matching_files(sequence, "color/*.png"));
    if (depth.empty()) throw DataError(folder + ": no depth images; expected depth/*.png");
    for (const auto& [number, file] : depth)
      if (number.size() > 9 || number.find_first_not_of("0123456789") != std::string::npos)
        throw DataError(file + ": the name of a frame is no number");
  }

  std::string folder;
  FilesByKey depth;  // FRAME
  FilesByKey color;  // FRAME
  FilesByKey masks;  // FRAME or FRAME_OBJECT
  FilesByKey flows;  // OBJECT_SOURCE_TARGET
  FilesByKey optical_flows;
  FilesByKey visible;
};

std::string path_or_empty(const FilesByKey& files, const std::string& key) {
  const auto found = files.find(key);
  return found == files.end() ? "" : found->second;
}

bool is_same_number(std::string_view a, std::string_view b) {
  return !NaturalOrder()(a, b) && !NaturalOrder()(b, a);
}

/// The objects that have a mask in a frame or whose motion from it is known.
std::set<std::string> objects_at(const std::string& frame, const SequenceFiles& files) {
  std::set<std::string> objects;
  for (const auto& [key, file] : files.masks)
    if (const std::size_t end = key.find('_');
        end != std::string::npos && is_same_number(key.substr(0, end), frame))
      objects.insert(key.substr(end + 1));
  for (const auto& [key, file] : files.flows) {
    const std::size_t target = key.rfind('_');
    if (target == std::string::npos || target == 0) continue;
    const std::size_t source = key.rfind('_', target - 1);
    if (source == std::string::npos) continue;
    if (is_same_number(key.substr(source + 1, target - source - 1), frame))
      objects.insert(key.substr(0, source));
  }
  return objects;
}

/// The one that is asked for, or the only one; empty where there is none.
std::string object_at(const std::string& frame, const SequenceFiles& files, const std::string& wanted) {
  const std::set<std::string> objects = objects_at(frame, files);
  const std::string at = fmt::format("{}: frame {}", files.folder, frame);
  if (!wanted.empty() && objects.count(wanted) == 0)
    throw DataError(fmt::format("{} has no mask and no scene flow of '{}'; it has {}", at, wanted,
                                objects.empty() ? "none" : fmt::format("{}", fmt::join(objects, ", "))));
  if (wanted.empty() && objects.size() > 1)
    throw DataError(
        fmt::format("{} has several objects, {}; say which by 'object'", at, fmt::join(objects, ", ")));
  if (!wanted.empty()) return wanted;
  return objects.empty() ? "" : *objects.begin();
}

FrameFiles files_of(const std::string& frame, const std::string& object, const SequenceFiles& files) {
  FrameFiles found{files.depth.at(frame), path_or_empty(files.color, frame), ""};
  if (!files.color.empty() && found.color.empty())
    throw DataError(fmt::format("{}: no colour for {}", files.folder, found.depth));
  if (!object.empty()) found.mask = path_or_empty(files.masks, frame + "_" + object);
  if (found.mask.empty()) found.mask = path_or_empty(files.masks, frame);
  return found;
}

TruthFiles truth_of(const std::string& object, const std::string& source, const std::string& target,
                    const SequenceFiles& files) {
  const std::string key = fmt::format("{}_{}_{}", object, source, target);
  return {path_or_empty(files.flows, key), path_or_empty(files.optical_flows, key),
          path_or_empty(files.visible, key)};
}

/// All frames; the motion to each is that from `frame`.
std::vector<Sequence::Item> frames_from(const std::string& frame, const std::string& object,
                                        const SequenceFiles& files) {
  std::vector<Sequence::Item> frames;
  for (const auto& [number, depth] : files.depth)
    frames.push_back({files_of(number, object, files), std::stoi(number) / frames_a_second,
                      truth_of(object, frame, number, files)});
  return frames;
}

class DeepDeform : public FrameSource {
 public:
  explicit DeepDeform(const Parameters& section)
      : folder_(section.text("folder")),
        object_(section.has("object") ? section.text("object") : ""),
        pair_(pair_numbers(section)),
        selection_(selection_of(section)),
        units_(depth_units_of(section)),
        camera_(camera_choice(section).value_or(CameraChoice{folder_ + "/intrinsics.txt", {}, ""})) {}

  std::unique_ptr<DataStream> open(Device& /*device*/, std::uint64_t /*seed*/) const override {
    const SequenceFiles files(folder_);
    Sequence sequence;
    sequence.name = name_of_folder(folder_);
    if (pair_) sequence.name += fmt::format(", {} to {}", pair_->source, pair_->target);
    sequence.frames = pair_ ? pair_of(files) : stream_of(files);
    sequence.camera = camera_;
    sequence.units = units_;
    return open_sequence(std::move(sequence));
  }

 private:
  std::vector<Sequence::Item> stream_of(const SequenceFiles& files) const {
    if (static_cast<std::size_t>(selection_.first) > files.depth.size())
      return selected({}, selection_, folder_);
    const std::string first = std::next(files.depth.begin(), selection_.first - 1)->first;
    return selected(frames_from(first, object_at(first, files, object_), files), selection_, folder_);
  }

  std::vector<Sequence::Item> pair_of(const SequenceFiles& files) const {
    const std::string source = existing(pair_->source, files);
    const std::string target = existing(pair_->target, files);
    const std::string object = object_at(source, files, object_);
    // The target may be an earlier frame, but is given as the later one.
    return {{files_of(source, object, files), 0},
            {files_of(target, object, files), std::abs(pair_->target - pair_->source) / frames_a_second,
             truth_of(object, source, target, files)}};
  }

  std::string existing(std::int64_t number, const SequenceFiles& files) const {
    const auto found = files.depth.find(std::to_string(number));
    if (found == files.depth.end())
      throw DataError(fmt::format("{}: there is no frame {}; its depth images are {} to {}", folder_, number,
                                  files.depth.begin()->first, files.depth.rbegin()->first));
    return found->first;
  }

  std::string folder_;
  std::string object_;  // empty: the only one
  std::optional<PairNumbers> pair_;
  Selection selection_;
  DepthUnits units_;
  CameraChoice camera_;
};

}  // namespace

void register_deepdeform(Registry& registry) {
  constexpr double millimetres = 1;
  registry.add<FrameSource>(
      "deepdeform",
      "A sequence in the layout of the DeepDeform data set, with its true motion where it is known",
      with_sequence(
          {
              path("folder").doc(
                  "with depth/, intrinsics.txt and, where there are some, color/, mask/, scene_flow/"),
              integer("source")
                  .range(0, 999'999'999)
                  .optional()
                  .doc("frame of a pair, the number of its file"),
              integer("target")
                  .range(0, 999'999'999)
                  .optional()
                  .doc("the other one; without both, the whole stream"),
              text("object").optional().doc("whose masks and motion are taken; the only one by default"),
          },
          millimetres),
      [](const Parameters& section, const Registry&) -> std::unique_ptr<FrameSource> {
        return std::make_unique<DeepDeform>(section);
      });
}

}  // namespace pliant
