#include "experiments/datasets/mesh_sources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "experiments/datasets/mesh_size.h"
#include "experiments/datasets/mesh_stream.h"
#include "experiments/datasets/scene_section.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"
#include "framework/io/gltf.h"

namespace pliant {
namespace {

PlayedAnimation read_animation(const Parameters& section, const std::vector<Animation>& animations,
                               const MeshScene& scene) {
  std::vector<std::string> names;
  for (const Animation& animation : animations) names.push_back(animation.name);
  const std::string& name = section.text("animation");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw ConfigError(fmt::format(
        "{}: 'animation' is '{}', which {} does not have; expected {}{}", section.place(), name, scene.what,
        names.empty() ? "none" : fmt::format("one of {}", fmt::join(names, ", ")), suggestion(name, names)));
  const double begin = section.real("animation_begin");
  const double duration = scene.time_of(scene.frames) - scene.time_of(1);
  return {animations[static_cast<std::size_t>(found - names.begin())], begin,
          section.has("animation_end") ? section.real("animation_end") : begin + duration};
}

std::unique_ptr<FrameSource> make_gltf(const Parameters& section, const Registry& /*components*/) {
  const std::string& file = section.text("mesh");
  const double scale = section.real("mesh_scale");
  GltfScene read = read_gltf_scene(file, {scale, section.boolean("chain_joints")});
  const Figure figure{std::move(read.mesh), {}};
  FigurePose identity = read_pose(figure, section.words("identity"),
                                  fmt::format("{}: 'identity' of {}", section.place(), file));
  MeshScene scene =
      read_scene(section, figure, std::move(identity), file, std::filesystem::path(file).stem().string());
  if (section.has("animation")) scene.animation = read_animation(section, read.animations, scene);
  scene.warnings = std::move(read.warnings);
  if (is_odd_size(scene.box))
    scene.warnings.push_back(fmt::format("{}: {}", file, described_size(scene.box, scale, "mesh_scale")));
  return std::make_unique<MeshSource>(std::move(scene));
}

}  // namespace

void register_figures(Registry& registry, const std::vector<FigureKind>& kinds) {
  for (const FigureKind& kind : kinds)
    registry.add<FrameSource>(
        kind.name, kind.doc, scene_table({group("identity", kind.identity).doc("which one it is")}),
        [kind](const Parameters& section, const Registry&) -> std::unique_ptr<FrameSource> {
          const Figure figure = kind.make(section.section("identity"));
          return std::make_unique<MeshSource>(
              read_scene(section, figure, rest_of(figure.mesh), kind.name, kind.name));
        });
}

void register_gltf(Registry& registry) {
  registry.add<FrameSource>(
      "gltf", "A mesh of a glTF file that changes its form, with its true motion",
      scene_table({
          path("mesh").doc("glTF file (.glb or .gltf), y up, looking along +z"),
          real("mesh_scale", millimetres_per_metre)
              .unit("mm")
              .above(0)
              .doc("what a unit of the file is; glTF's is the metre"),
          boolean("chain_joints", false)
              .doc("build chains of joints that are all children of one node by what they are called, as in "
                   "hands of WebXR"),
          text("animation").optional().doc("motion of the file that is played beneath all poses"),
          real("animation_begin", 0).unit("s").at_least(0).doc("where in the animation the first frame is"),
          real("animation_end")
              .unit("s")
              .at_least(0)
              .optional()
              .doc("where the last frame is; by default as long after as the stream takes"),
          words("identity").optional().doc("which one it is: a pose beneath all others"),
      }),
      make_gltf);
}

}  // namespace pliant
