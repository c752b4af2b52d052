#include "experiments/datasets/tum.h"

#include <memory>
#include <string>
#include <utility>

#include "experiments/datasets/sequence.h"
#include "experiments/datasets/tum_lists.h"

namespace pliant {
namespace {

/// The cameras of the benchmark, as its page on calibration gives them; without their lens terms.
Camera benchmark_camera(const std::string& name) {
  if (name == "freiburg1") return {517.3, 516.5, 318.6, 255.3, 0, 0};
  if (name == "freiburg2") return {520.9, 521.0, 325.1, 249.7, 0, 0};
  if (name == "freiburg3") return {535.4, 539.2, 320.1, 247.6, 0, 0};
  return {525, 525, 319.5, 239.5, 0, 0};
}

class Tum : public FrameSource {
 public:
  explicit Tum(const Parameters& section)
      : settings_(sequence_settings(section, camera_choice(section).value_or(
                                                 CameraChoice{"", benchmark_camera(section.text("camera")),
                                                              "camera: " + section.text("camera")}))) {}

  std::unique_ptr<DataStream> open(Device& /*device*/, std::uint64_t /*seed*/) const override {
    TumFrames read = read_tum_lists(settings_.folder);
    Sequence sequence = sequence_of(settings_, read.frames, settings_.folder);
    sequence.warnings = std::move(read.warnings);
    return open_sequence(std::move(sequence));
  }

 private:
  SequenceSettings settings_;
};

}  // namespace

void register_tum(Registry& registry) {
  constexpr double tum_scale = 0.2;
  registry.add<FrameSource>(
      "tum", "A sequence in the layout of the TUM RGB-D benchmark",
      with_sequence(
          {
              path("folder").doc("with associations.txt, or depth.txt and rgb.txt, the images they name, and "
                                 "groundtruth.txt where there is one"),
              choice("camera", {"freiburg1", "freiburg2", "freiburg3", "ros_default"}, "ros_default")
                  .doc("a camera of the benchmark, where neither 'intrinsics' nor numbers are given"),
          },
          tum_scale),
      [](const Parameters& section, const Registry&) -> std::unique_ptr<FrameSource> {
        return std::make_unique<Tum>(section);
      });
}

}  // namespace pliant
