#include "experiments/datasets/rgbd_pair.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "experiments/datasets/depth_camera.h"
#include "experiments/datasets/depth_doubts.h"
#include "experiments/datasets/stored_pair.h"
#include "framework/core/error.h"
#include "framework/io/intrinsics.h"

namespace pliant {
namespace {

/// Gives the rig the colour camera of its own, whose images have the size of those that there are.
void add_color_camera(const RgbdPair::Settings& settings, StoredPair& pair) {
  const bool source_has_it = !pair.source.color.empty();
  const ColorImage& color = source_has_it ? pair.source.color : pair.target.color;
  if (source_has_it && !pair.target.color.empty())
    check_size(pair.target.color, settings.target.color, color, "the colour image " + settings.source.color);
  Intrinsics intrinsics = read_intrinsics(settings.color_intrinsics, color.width(), color.height());
  pair.rig.color = intrinsics.camera;
  pair.rig.color_from_depth = settings.color_from_depth;
  add(std::move(intrinsics.warnings), pair.warnings);
  add(doubts_about_distance(settings.color_from_depth, pair.name), pair.warnings);
}

std::string path_or_empty(const Parameters& section, const std::string& name) {
  return section.has(name) ? section.text(name) : "";
}

void read_color_camera(const Parameters& section, RgbdPair::Settings& settings) {
  if (!section.has("color_intrinsics") && !section.has("color_from_depth")) return;
  if (!section.has("color_intrinsics") || !section.has("color_from_depth"))
    throw ConfigError(fmt::format(
        "{}: a colour camera of its own has both 'color_intrinsics' and 'color_from_depth'; '{}' is missing",
        section.place(), section.has("color_intrinsics") ? "color_from_depth" : "color_intrinsics"));
  if (settings.source.color.empty() && settings.target.color.empty())
    throw ConfigError(
        fmt::format("{}: 'color_intrinsics' without a 'color' of 'source' or 'target'", section.place()));
  settings.color_intrinsics = section.text("color_intrinsics");
  settings.color_from_depth = rigid_matrix(section, "color_from_depth");
}

FrameFiles frame_files(const Parameters& section) {
  return {section.text("depth"), path_or_empty(section, "color"), path_or_empty(section, "mask")};
}

ParameterTable frame_table() {
  return {
      path("depth").doc("16-bit PNG of depth, 0 where there is none"),
      path("color").optional().doc("PNG or JPEG; has the depth's pixels unless color_intrinsics is given"),
      path("mask").optional().doc("PNG, not black and not transparent on the object"),
  };
}

}  // namespace

std::unique_ptr<DataStream> RgbdPair::open(Device& /*device*/, std::uint64_t /*seed*/) const {
  StoredPair pair;
  const auto stem = [](const std::string& path) { return std::filesystem::path(path).stem().string(); };
  pair.name = stem(settings_.source.depth) + " to " + stem(settings_.target.depth);
  const DepthUnits units{settings_.depth_scale, settings_.max_depth};
  const bool has_color_camera = !settings_.color_intrinsics.empty();
  pair.source = read_frame(settings_.source, units, has_color_camera);
  check_sees_something(pair.source, settings_.source, units);
  pair.target = read_frame(settings_.target, units, has_color_camera);
  check_sees_something(pair.target, settings_.target, units);
  check_size(pair.target.depth, settings_.target.depth, pair.source.depth,
             depth_named(settings_.source.depth));
  Intrinsics intrinsics =
      read_intrinsics(settings_.intrinsics, pair.source.depth.width(), pair.source.depth.height());
  pair.rig.depth = intrinsics.camera;
  pair.warnings = std::move(intrinsics.warnings);
  if (has_color_camera) add_color_camera(settings_, pair);
  const double depth_scale = settings_.depth_scale;
  add(doubts_about_depth(pair.source, depth_scale, settings_.source.depth), pair.warnings);
  add(doubts_about_depth(pair.target, depth_scale, settings_.target.depth), pair.warnings);
  if (!settings_.scene_flow.empty())
    pair.truth = read_truth({settings_.scene_flow}, pair.source, settings_.source.depth);
  return std::make_unique<StoredPairStream>(std::move(pair));
}

void register_rgbd_pair(Registry& registry) {
  registry.add<FrameSource>(
      "rgbd_pair", "Two RGB-D images from files, seen by one camera or by two",
      {
          group("source", frame_table()).doc("the image that is deformed"),
          group("target", frame_table()).doc("the image it is deformed to"),
          path("intrinsics").doc("text file with the 3x3 or 4x4 camera matrix in pixels"),
          path("color_intrinsics")
              .optional()
              .doc("likewise of the colour camera, where colour is seen by one of its own"),
          reals("color_from_depth", 16)
              .unit("mm")
              .optional()
              .doc("4x4 matrix, row by row, from the depth camera's frame to the colour camera's"),
          path("scene_flow").optional().doc("true motion of every source pixel (.sflow)"),
          real("depth_scale", 1)
              .unit("mm")
              .above(0)
              .doc("what a unit of the depth images is; 0.2 where they count 5000 a metre, as TUM's do"),
          real("max_depth")
              .unit("mm")
              .above(0)
              .optional()
              .doc("farther depth is dropped; nothing by default"),
      },
      [](const Parameters& parameters, const Registry&) -> std::unique_ptr<FrameSource> {
        RgbdPair::Settings settings;
        settings.source = frame_files(parameters.section("source"));
        settings.target = frame_files(parameters.section("target"));
        settings.intrinsics = parameters.text("intrinsics");
        read_color_camera(parameters, settings);
        settings.scene_flow = path_or_empty(parameters, "scene_flow");
        settings.depth_scale = parameters.real("depth_scale");
        if (parameters.has("max_depth")) settings.max_depth = parameters.real("max_depth");
        return std::make_unique<RgbdPair>(std::move(settings));
      });
}

}  // namespace pliant
