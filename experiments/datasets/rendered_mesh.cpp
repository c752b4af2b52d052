#include "experiments/datasets/rendered_mesh.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "experiments/datasets/figure_pose.h"
#include "experiments/datasets/kinect_noise.h"
#include "experiments/datasets/mesh_size.h"
#include "experiments/datasets/rigid_motion.h"
#include "experiments/datasets/stored_pair.h"
#include "experiments/datasets/texture.h"
#include "experiments/datasets/virtual_camera.h"
#include "framework/core/error.h"
#include "framework/core/nearest.h"
#include "framework/geometry/bounding_box.h"
#include "framework/geometry/render.h"
#include "framework/io/gltf.h"

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// The weight in "name=weight", none when that is not how the item is written.
std::optional<double> parse_weight(const std::string& item, std::size_t equals) {
  if (equals == std::string::npos) return std::nullopt;
  double weight = 0;
  const char* end = item.data() + item.size();
  const auto [stop, error] = std::from_chars(item.data() + equals + 1, end, weight);
  if (error != std::errc() || stop != end || !std::isfinite(weight)) return std::nullopt;
  return weight;
}

Points transformed(Points points, const Eigen::Affine3d& transform) {
  for (Eigen::Vector3d& point : points) point = transform * point;
  return points;
}

Frame picture_of(const Image<Fragment>& seen, const std::vector<Eigen::Vector3i>& triangles,
                 const Points& at_rest) {
  Frame frame{depth_of(seen), ColorImage(seen.width(), seen.height()), {}};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Fragment& fragment = seen.data()[i];
    if (fragment.triangle < 0) continue;
    frame.color.data()[i] = texture_color(interpolate(fragment, triangles, at_rest));
  }
  return frame;
}

/// Takes the depth away from the left `share` of the columns between the first and the last with depth.
void hide_left_part(DepthImage& depth, double share) {
  int first = depth.width();
  int end = 0;
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) {
      if (depth(u, v) <= 0) continue;
      first = std::min(first, u);
      end = std::max(end, u + 1);
    }
  }
  const int stop = first + static_cast<int>(std::lround(share * (end - first)));
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = first; u < stop; ++u) depth(u, v) = 0;
  }
}

}  // namespace

RenderedMesh::RenderedMesh(Settings settings)
    : settings_(std::move(settings)), mesh_(read_gltf(settings_.mesh, settings_.mesh_scale)) {
  identity_ = weights_of("identity", settings_.identity);
  const auto with_identity = [this](std::vector<double> weights) {
    std::transform(weights.begin(), weights.end(), identity_.begin(), weights.begin(), std::plus<>());
    return weights;
  };
  source_ = with_identity(weights_of("source", settings_.source));
  target_ = with_identity(weights_of("target", settings_.target));
}

std::vector<double> RenderedMesh::weights_of(const std::string& key,
                                             const std::vector<std::string>& expression) const {
  const std::vector<std::string> names = mesh_.target_names();
  std::vector<double> weights(names.size(), 0);
  std::vector<bool> given(names.size(), false);
  for (const std::string& item : expression) {
    const std::size_t equals = item.rfind('=');
    const auto weight = parse_weight(item, equals);
    if (!weight) {
      throw ConfigError(
          fmt::format("rendered_mesh: '{}' in '{}'; expected name=weight, as in mouthOpen=0.5", item, key));
    }
    const std::string name = item.substr(0, equals);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      throw ConfigError(fmt::format(
          "rendered_mesh: '{}' in '{}' is no morph target of {}; expected {}{}", name, key, settings_.mesh,
          names.empty() ? "none, for it has none" : fmt::format("one of {}", fmt::join(names, ", ")),
          suggestion(name, names)));
    }
    const auto i = static_cast<std::size_t>(found - names.begin());
    if (given[i]) throw ConfigError(fmt::format("rendered_mesh: '{}' is given twice in '{}'", name, key));
    given[i] = true;
    weights[i] = *weight;
  }
  return weights;
}

/// Of the neutral mesh, in mm in its own frame, so that an expression does not move the rest of the face.
Eigen::AlignedBox3d RenderedMesh::box() const { return box_around(mesh_.deform(identity_)); }

/// From the mesh's frame (y up, looking along +z) to the camera's, the middle of the mesh on the optical
/// axis.
Eigen::Affine3d RenderedMesh::placement() const {
  return Eigen::Translation3d(0, 0, settings_.distance) *
         Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()) *
         Eigen::Translation3d(-box().center());
}

void RenderedMesh::check_is_seen(const Image<Fragment>& seen, const char* which) const {
  const Eigen::Vector3d size = box().sizes();
  const bool is_inside = size.z() / 2 >= settings_.distance;
  const auto& pixels = seen.pixels();
  const auto shows = [](const Fragment& fragment) { return fragment.triangle >= 0; };
  if (!is_inside && std::any_of(pixels.begin(), pixels.end(), shows)) return;
  throw DataError(fmt::format("{}: {} {} mesh {:g} mm away; {}", settings_.mesh,
                              is_inside ? "the camera is inside the" : "no pixel of the camera sees the",
                              which, settings_.distance, size_and_unit()));
}

std::string RenderedMesh::size_and_unit() const {
  return described_size(box(), settings_.mesh_scale, "mesh_scale");
}

std::unique_ptr<DataStream> RenderedMesh::open(Device& /*device*/, std::uint64_t seed) const {
  const Camera& camera = settings_.camera;
  const Eigen::Translation3d to_middle(0, 0, settings_.distance);
  const Points source = transformed(mesh_.deform(source_), placement());
  const Points target =
      transformed(mesh_.deform(target_), to_middle * settings_.motion * to_middle.inverse() * placement());
  const Points at_rest = mesh_.deform(std::vector<double>(mesh_.targets.size(), 0));
  const Image<Fragment> seen_source = render_mesh(source, mesh_.triangles, camera);
  const Image<Fragment> seen_target = render_mesh(target, mesh_.triangles, camera);
  check_is_seen(seen_source, "source");
  check_is_seen(seen_target, "target");

  StoredPair pair;
  pair.name = fmt::format("{}, {} to {}", std::filesystem::path(settings_.mesh).stem().string(),
                          name_of_pose(settings_.source), name_of_pose(settings_.target));
  pair.rig.depth = camera;
  if (is_odd_size(box())) pair.warnings.push_back(fmt::format("{}: {}", settings_.mesh, size_and_unit()));
  pair.source = picture_of(seen_source, mesh_.triangles, at_rest);
  pair.target = picture_of(seen_target, mesh_.triangles, at_rest);
  pair.truth = PairTruth{scene_flow(seen_source, mesh_.triangles, source, target)};
  KinectNoise noise(settings_.noise, camera.fx, seed);
  noise.disturb(pair.source.depth);
  noise.disturb(pair.target.depth);
  // After the noise, so that what is left is the same with and without.
  hide_left_part(pair.target.depth, settings_.hide_left);
  return std::make_unique<StoredPairStream>(std::move(pair));
}

void register_rendered_mesh(Registry& registry) {
  const RenderedMesh::Settings defaults;
  registry.add<FrameSource>(
      "rendered_mesh", "A mesh seen with one expression and then another, with its true motion",
      with_camera({
          path("mesh").doc("binary glTF file (.glb), y up, looking along +z"),
          real("mesh_scale", defaults.mesh_scale)
              .unit("mm")
              .above(0)
              .doc("what a unit of the file is; glTF's is the metre"),
          words("identity").optional().doc("who it is: weights of morph targets, as in [identity000=0.5]"),
          words("source").optional().doc("expression of the source, as in [jawOpen=0.5, mouthLeft=1]"),
          words("target").optional().doc("expression of the target, likewise"),
          group("motion", motion_table()).doc("rigid motion of the target about the middle of the mesh"),
          real("distance", defaults.distance)
              .unit("mm")
              .above(0)
              .doc("from the camera to the middle of the mesh"),
          real("noise", 0).range(0, 10).doc("strength of Kinect-like depth noise: 0 none, 1 as the camera"),
          real("hide_left", 0)
              .range(0, 0.9)
              .doc("share of the target's width, from its left in the image, that has no depth"),
      }),
      [](const Parameters& parameters, const Registry&) -> std::unique_ptr<FrameSource> {
        RenderedMesh::Settings settings;
        settings.mesh = parameters.text("mesh");
        settings.mesh_scale = parameters.real("mesh_scale");
        settings.identity = parameters.words("identity");
        settings.source = parameters.words("source");
        settings.target = parameters.words("target");
        settings.motion = read_motion(parameters.section("motion")).transform();
        settings.camera = virtual_camera(parameters);
        settings.distance = parameters.real("distance");
        settings.noise = parameters.real("noise");
        settings.hide_left = parameters.real("hide_left");
        return std::make_unique<RenderedMesh>(std::move(settings));
      });
}

}  // namespace pliant
