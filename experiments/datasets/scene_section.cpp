#include "experiments/datasets/scene_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/datasets/figure_pose.h"
#include "experiments/datasets/virtual_camera.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr int most_frames = 1000000;

ParameterTable key_table() {
  return {
      real("at").unit("s").at_least(0).doc(
          "when it is reached, later than the key before; 30 frames a second"),
      words("pose").optional().doc("as of source and target"),
      group("motion", motion_table()).doc("rigid motion of the mesh about its middle"),
      group("camera", camera_pose_table()).doc("where the rig is"),
  };
}

ParameterTable color_camera_table() {
  ParameterTable camera = with_camera({});
  std::vector<Parameter> rows = camera.rows();
  rows.push_back(reals("shift", 3, std::vector<double>{0, 0, 0})
                     .unit("mm")
                     .doc("where it stands, in the depth camera's frame: x right, y down, z forward"));
  rows.push_back(reals("rotation", 3, std::vector<double>{0, 0, 0})
                     .unit("degree")
                     .doc("how it is turned in that frame about x, then y, then z"));
  return ParameterTable(std::move(rows));
}

Rig read_rig(const Parameters& section) {
  Rig rig{virtual_camera(section)};
  if (!section.has("color_camera")) return rig;
  const Parameters& color = section.section("color_camera");
  rig.color = virtual_camera(color);
  CameraPose pose;
  pose.position = Eigen::Map<const Eigen::Vector3d>(color.reals("shift").data());
  pose.orientation = turned(Eigen::Map<const Eigen::Vector3d>(color.reals("rotation").data()));
  rig.color_from_depth = pose.camera_from_scene();
  return rig;
}

/// At which the middle of a box fills four fifths of the image, but no nearer than depth cameras see.
double fitting_distance(const Eigen::Vector3d& size, const Camera& camera) {
  constexpr double filled = 0.8;
  constexpr double nearest = 400;  // mm, of the first Kinect in its near mode
  const double wide = size.x() * camera.fx / (filled * camera.width);
  const double high = size.y() * camera.fy / (filled * camera.height);
  return std::max({wide, high, nearest + size.z() / 2});
}

std::string place_of(const Parameters& section, const std::string& what, const std::string& key) {
  return fmt::format("{}: '{}' of {}", section.place(), key, what);
}

/// Reads what a section says about the way of a scene.
class KeyReader {
 public:
  KeyReader(const Parameters& section, const Figure& figure, const std::string& what)
      : section_(section), figure_(figure), what_(what) {}

  /// From `source` to `target` in `frames`.
  void read_pair(MeshScene& scene) const {
    SceneKey source{0, pose(section_, "source"), {}, {}};
    SceneKey target{0, pose(section_, "target"), read_motion(section_.section("motion")), {}};
    scene.frames = static_cast<int>(section_.integer("frames"));
    target.time = (scene.frames - 1) / frame_rate;
    scene.name += fmt::format(", {} to {}", name_of_pose(section_.words("source")),
                              name_of_pose(section_.words("target")));
    scene.keys = {std::move(source), std::move(target)};
  }

  void read_keys(MeshScene& scene) const {
    const auto& keys = section_.sections("keys");
    if (!section_.words("source").empty() || !section_.words("target").empty())
      throw ConfigError(
          fmt::format("{}: {} has both 'keys' and a 'source' or 'target'; expected one of the two",
                      section_.place(), what_));
    for (const auto& [name, key] : keys) {
      scene.keys.push_back({key.real("at"), pose(key, "pose"), read_motion(key.section("motion")),
                            read_camera_pose(key.section("camera"), {0, 0, scene.distance})});
      check_order(scene.keys, name, key);
    }
    const double duration = scene.keys.back().time - scene.keys.front().time;
    constexpr double rounding = 1e-6;
    const double frames = std::floor(duration * frame_rate + rounding) + 1;
    if (frames < 2 || frames > most_frames)
      throw ConfigError(fmt::format("{}: 'keys' of {} take {:g} s; expected 2 to {} frames at 30 a second",
                                    section_.place(), what_, duration, most_frames));
    scene.frames = static_cast<int>(frames);
    scene.name += fmt::format(", {} to {}", keys.front().first, keys.back().first);
  }

  FigurePose pose(const Parameters& section, const std::string& key) const {
    return read_pose(figure_, section.words(key), place_of(section, what_, key));
  }

 private:
  void check_order(const std::vector<SceneKey>& keys, const std::string& name, const Parameters& key) const {
    if (keys.size() < 2 || keys.back().time > (keys.end() - 2)->time) return;
    throw ConfigError(
        fmt::format("{}: key '{}' of {} is at {:g} s; expected later than {:g} s, the key before",
                    key.place(), name, what_, keys.back().time, (keys.end() - 2)->time));
  }

  const Parameters& section_;
  const Figure& figure_;
  const std::string& what_;
};

SurfaceColor read_color(const Parameters& section, const Figure& figure, const std::string& what) {
  const std::string& texture = section.text("texture");
  const auto seed = static_cast<std::uint64_t>(section.integer("texture_seed"));
  if (texture == "rich") return {SurfaceColor::Kind::rich, seed};
  if (texture == "skin") return {SurfaceColor::Kind::skin, seed};
  if (figure.patches.empty())
    throw ConfigError(place_of(section, what, "texture") +
                      " is face, which only a head has; expected rich or skin");
  return {SurfaceColor::Kind::skin, seed, figure.patches};
}

}  // namespace

ParameterTable scene_table(std::vector<Parameter> rows) {
  rows.push_back(
      words("source").optional().doc("pose of the first frame: named poses, morph targets and angles of "
                                     "joints in degrees, as in [smile=0.5, "
                                     "index_1.x=40]"));
  rows.push_back(words("target").optional().doc("pose of the last frame, likewise"));
  rows.push_back(
      group("motion", motion_table()).doc("rigid motion of the last frame about the middle of the mesh"));
  rows.push_back(integer("frames", 2)
                     .range(2, most_frames)
                     .doc("length of the stream from source to target; a pair is its first two"));
  rows.push_back(
      groups("keys", key_table())
          .optional()
          .at_least(2)
          .doc("instead of source and target: what is passed on the way, by names in order of time"));
  rows.push_back(real("distance")
                     .unit("mm")
                     .above(0)
                     .optional()
                     .doc("from the camera to the middle of the mesh; by default it fills four fifths of the "
                          "image, at 400 mm or more"));
  rows.push_back(
      choice("texture", {"rich", "skin", "face"}, "rich")
          .doc("colour: features everywhere, hardly any, or skin with the eyes, brows and lips of a head"));
  rows.push_back(integer("texture_seed", 1).at_least(0).doc("of the colour"));
  rows.push_back(group("sensor", depth_sensor_table()).doc("errors of the depth camera; none by default"));
  ParameterTable table = with_camera(std::move(rows));
  std::vector<Parameter> all = table.rows();
  all.push_back(group("color_camera", color_camera_table())
                    .optional()
                    .doc("a camera of its own for colour; without, colour has the depth's pixels"));
  return ParameterTable(std::move(all));
}

MeshScene read_scene(const Parameters& section, const Figure& figure, FigurePose base,
                     const std::string& what, const std::string& title) {
  const KeyReader reader(section, figure, what);
  const Eigen::AlignedBox3d box = box_around(figure.mesh, base);
  MeshScene scene{what,
                  title,
                  figure.mesh,
                  std::move(base),
                  box,
                  std::nullopt,
                  0,
                  read_rig(section),
                  {},
                  0,
                  read_color(section, figure, what),
                  read_depth_sensor(section.section("sensor")),
                  {}};
  scene.distance =
      section.has("distance") ? section.real("distance") : fitting_distance(box.sizes(), scene.rig.depth);
  if (section.sections("keys").empty())
    reader.read_pair(scene);
  else
    reader.read_keys(scene);
  return scene;
}

}  // namespace pliant
