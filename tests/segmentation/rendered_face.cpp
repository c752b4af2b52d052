#include "tests/segmentation/rendered_face.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "experiments/datasets/datasets.h"
#include "experiments/datasets/mesh_stream.h"
#include "framework/config/config.h"
#include "framework/geometry/render.h"
#include "framework/segmentation/segmentations.h"

namespace pliant::test {
namespace {

/// The component of a kind that a section describes.
template <class Interface>
std::unique_ptr<Interface> made(const std::string& section) {
  Registry registry;
  register_datasets(registry);
  register_segmentations(registry);
  const ConfigText text{"it: " + section + "\n", "text", ""};
  const Experiment experiment = load_experiment({text, {}, {}}, {component("it", Interface::kind)}, registry);
  return registry.make<Interface>(experiment.values.section("it"));
}

}  // namespace

std::unique_ptr<Segmentation> segmentation_of(const std::string& section) {
  return made<Segmentation>(section);
}

RenderedFace rendered_face(const std::string& rest) {
  static Device& device = *new Device;  // never closed: OpenCL drivers end before what is static here does
  const auto source = made<FrameSource>(
      "{type: head, texture: face, distance: 700, color_camera: {image_width: 800, image_height: 600, "
      "focal_length: 700, cx: 410, cy: 290, shift: [70, -25, 10], rotation: [3, -5, 4]}" +
      rest + "}");
  const auto opened = source->open(device, 1);
  auto& stream = dynamic_cast<MeshStream&>(*opened);
  RenderedFace face{stream.rig(), stream.next().value(), {}};
  const MeshScene& scene = stream.scene();
  std::vector<Eigen::Vector3d> vertices = scene.vertices_at(scene.time_of(1));
  for (Eigen::Vector3d& vertex : vertices) vertex = face.rig.color_from_depth * vertex;
  face.color_depth = depth_of(render_mesh(vertices, scene.mesh.triangles, face.rig.color.value()));
  return face;
}

PixelWindow true_window(const PixelWindow& color_window, const RenderedFace& face) {
  const Eigen::Isometry3d depth_from_color = face.rig.color_from_depth.inverse();
  Eigen::AlignedBox2d box;
  for (int v = color_window.top; v < color_window.top + color_window.height; ++v)
    for (int u = color_window.left; u < color_window.left + color_window.width; ++u)
      if (const float depth = face.color_depth(u, v); depth > 0)
        box.extend(face.rig.depth.project(depth_from_color * face.rig.color->unproject(u, v, depth)));
  const Eigen::Array2i first = box.min().array().round().cast<int>();
  const Eigen::Array2i last = box.max().array().round().cast<int>();
  return {first.x(), first.y(), last.x() - first.x() + 1, last.y() - first.y() + 1};
}

int difference(const PixelWindow& a, const PixelWindow& b) {
  return std::max({std::abs(a.left - b.left), std::abs(a.top - b.top),
                   std::abs(a.left + a.width - b.left - b.width),
                   std::abs(a.top + a.height - b.top - b.height)});
}

}  // namespace pliant::test
