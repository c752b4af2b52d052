#include "experiments/datasets/openni.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "experiments/datasets/openni_stream.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

OpenNiDevice::Settings device_settings(const Parameters& section) {
  if (section.has("recording") && section.has("device"))
    throw ConfigError(section.place() + ": both a 'recording' and a 'device' are given");
  OpenNiDevice::Settings device;
  if (section.has("recording")) device.recording = section.text("recording");
  if (section.has("device")) device.uri = section.text("device");
  if (section.has("registered")) device.registered = section.boolean("registered");
  device.color = section.boolean("color");
  return device;
}

/// Whether the section says where a colour camera apart from the depth's is, or what it is like.
bool has_color_camera(const Parameters& section) {
  return section.has("color_intrinsics") || section.has("color_from_depth");
}

OpenNiStream::Settings stream_settings(const Parameters& section) {
  OpenNiStream::Settings settings{device_settings(section), selection_of(section), camera_choice(section)};
  if (has_color_camera(section) && (!settings.device.color || settings.device.registered.value_or(false)))
    throw ConfigError(fmt::format("{}: a colour camera of its own, but colour is {}", section.place(),
                                  settings.device.color ? "'registered'" : "not wanted"));
  // Without a word about registration a colour camera of its own is one that depth is not registered to.
  if (has_color_camera(section)) settings.device.registered = false;
  if (section.has("color_intrinsics")) settings.color_intrinsics = section.text("color_intrinsics");
  if (section.has("color_from_depth")) settings.color_from_depth = rigid_matrix(section, "color_from_depth");
  return settings;
}

class OpenNiSource : public FrameSource {
 public:
  explicit OpenNiSource(OpenNiStream::Settings settings) : settings_(std::move(settings)) {}
  std::unique_ptr<DataStream> open(Device& /*device*/, std::uint64_t /*seed*/) const override {
    return std::make_unique<OpenNiStream>(settings_);
  }

 private:
  OpenNiStream::Settings settings_;
};

ParameterTable openni_table() {
  std::vector<Parameter> rows{
      path("recording").optional().doc("a recording, .oni; without one, a camera that is plugged in"),
      text("device").optional().doc("the camera's URI; by default the first one that is found"),
      boolean("color", true).doc("whether colour is taken, where there is some"),
      boolean("registered")
          .optional()
          .doc("whether depth has the colour camera's view; a camera is asked to wherever it can, a "
               "recording is taken for not"),
      path("color_intrinsics")
          .optional()
          .doc("of the colour where it is not registered; by its field of view"),
      reals("color_from_depth", 16)
          .unit("mm")
          .optional()
          .doc("motion from the depth camera's frame to the colour camera's, likewise, 4x4 row by row"),
  };
  add_selection(rows);
  return with_intrinsics(std::move(rows));
}

}  // namespace

void register_openni(Registry& registry) {
  registry.add<FrameSource>("openni", "A depth camera that OpenNI2 drives, or a recording of one (.oni)",
                            openni_table(),
                            [](const Parameters& section, const Registry&) -> std::unique_ptr<FrameSource> {
                              return std::make_unique<OpenNiSource>(stream_settings(section));
                            });
}

}  // namespace pliant
