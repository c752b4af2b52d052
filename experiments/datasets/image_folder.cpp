#include "experiments/datasets/image_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "experiments/datasets/numbered_files.h"
#include "experiments/datasets/sequence.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

/// The pattern under a key; empty where there is none. Throws ConfigError unless it has one star, in its last
/// part.
std::string pattern_of(const Parameters& section, const char* key) {
  if (!section.has(key)) return "";
  const std::string& pattern = section.text(key);
  const std::size_t star = pattern.find('*');
  if (star == std::string::npos || pattern.find('*', star + 1) != std::string::npos ||
      pattern.find('/', star) != std::string::npos)
    throw ConfigError(
        fmt::format("{}: '{}' is '{}'; expected one * in the name of the file, as in depth/*.png",
                    section.place(), key, pattern));
  return pattern;
}

CameraChoice camera_of(const Parameters& section) {
  if (auto camera = camera_choice(section)) return *std::move(camera);
  throw ConfigError(section.place() + ": the camera is missing; expected 'intrinsics', or fx, fy, cx and cy");
}

class ImageFolder : public FrameSource {
 public:
  explicit ImageFolder(const Parameters& section)
      : depth_(pattern_of(section, "depth")),
        color_(pattern_of(section, "color")),
        mask_(pattern_of(section, "mask")),
        rate_(section.real("rate")),
        settings_(sequence_settings(section, camera_of(section))) {}

  std::unique_ptr<DataStream> open(Device& /*device*/, std::uint64_t /*seed*/) const override {
    const std::string& folder = settings_.folder;
    Sequence sequence = sequence_of(settings_, frames(), (std::filesystem::path(folder) / depth_).string());
    const auto has_mask = [](const Sequence::Item& frame) { return !frame.files.mask.empty(); };
    const auto masks = std::count_if(sequence.frames.begin(), sequence.frames.end(), has_mask);
    if (!mask_.empty() && masks < static_cast<long>(sequence.frames.size()))
      sequence.warnings.push_back(fmt::format("{}: {} of {} frames have no mask, all of their depth counts",
                                              folder, static_cast<long>(sequence.frames.size()) - masks,
                                              sequence.frames.size()));
    return open_sequence(std::move(sequence));
  }

 private:
  std::vector<Sequence::Item> frames() const {
    const std::string& folder = settings_.folder;
    const FilesByKey colors = color_.empty() ? FilesByKey() : matching_files(folder, color_);
    const FilesByKey masks = mask_.empty() ? FilesByKey() : matching_files(folder, mask_);
    std::vector<Sequence::Item> frames;
    for (const auto& [key, depth] : matching_files(folder, depth_)) {
      Sequence::Item frame{{depth, "", ""}, static_cast<double>(frames.size()) / rate_};
      if (const auto color = colors.find(key); color != colors.end()) frame.files.color = color->second;
      if (const auto mask = masks.find(key); mask != masks.end()) frame.files.mask = mask->second;
      if (!color_.empty() && frame.files.color.empty())
        throw DataError(fmt::format("{}: no colour like {} for {}", folder, color_, depth));
      frames.push_back(std::move(frame));
    }
    return frames;
  }

  std::string depth_;  // patterns
  std::string color_;
  std::string mask_;
  double rate_;  // frames a second
  SequenceSettings settings_;
};

}  // namespace

void register_image_folder(Registry& registry) {
  constexpr double millimetres = 1;
  registry.add<FrameSource>(
      "folder", "A sequence of depth PNGs in a folder, with colour and masks by the patterns of their names",
      with_sequence(
          {
              path("folder").doc("where the images are"),
              text("depth", "depth/*.png").doc("16-bit PNGs of depth below it; frames are sorted by the *"),
              text("color").optional().doc("PNGs or JPEGs with the depth's pixels, as color/*.jpg"),
              text("mask").optional().doc(
                  "PNGs, not black and not transparent on the object; not all need one"),
              real("rate", 30).unit("frames/s").above(0).doc("how many frames a second there are"),
          },
          millimetres),
      [](const Parameters& section, const Registry&) -> std::unique_ptr<FrameSource> {
        return std::make_unique<ImageFolder>(section);
      });
}

}  // namespace pliant
