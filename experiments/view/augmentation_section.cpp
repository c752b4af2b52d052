#include "experiments/view/augmentation_section.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "experiments/datasets/camera_path.h"
#include "framework/io/gltf.h"

namespace pliant {
namespace {

Eigen::Vector3d vector(const Parameters& section, const char* name) {
  return Eigen::Map<const Eigen::Vector3d>(section.reals(name).data());
}

Rgb read_color(const Parameters& section) {
  const Eigen::Vector3d color = vector(section, "color");
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {byte(color.x()), byte(color.y()), byte(color.z())};
}

SurfaceMesh read_mesh(const std::string& file, double scale) {
  const auto extension = std::filesystem::path(file).extension();
  if (extension == ".ply" || extension == ".obj") return read_surface_mesh(file, scale);
  GltfScene scene = read_gltf_scene(file, {scale, false, true});
  SurfaceMesh mesh{{}, std::move(scene.mesh.triangles), std::move(scene.colors)};
  for (const Eigen::Vector3d& vertex : scene.mesh.deform(scene.mesh.rest()))
    mesh.vertices.emplace_back(vertex.cast<float>());
  return mesh;
}

}  // namespace

ParameterTable augmentation_table() {
  return {
      path("mesh").doc("glTF (.glb or .gltf), PLY or OBJ file, y up, looking along +z"),
      real("scale", millimetres_per_metre).unit("mm").above(0).doc("what a unit of the file is"),
      reals("at", 3, std::vector<double>{0, 0, 0})
          .unit("mm")
          .doc("where its origin is fixed, in the model's frame, that of the first depth image: x right, y "
               "down, z forward"),
      reals("turn", 3, std::vector<double>{0, 0, 0})
          .unit("degree")
          .doc("how it is turned in that frame about x, then y, then z, from upright and facing the camera"),
      reals("color", 3, std::vector<double>{240, 170, 40})
          .range(0, 255)
          .doc("red, green and blue, 0 to 255, of an object whose file has no colours but textures"),
      real("reach", 30)
          .unit("mm")
          .above(0)
          .doc("where points are `followed`, the nearest ones within this of `at` carry it"),
      real("tolerance", 5)
          .unit("mm")
          .at_least(0)
          .doc("so far the measured surface may be before it without hiding it"),
  };
}

Augmentation::Object read_object(const Parameters& section) {
  Augmentation::Object object{read_mesh(section.text("mesh"), section.real("scale"))};
  if (object.mesh.colors.empty()) object.mesh.colors.assign(object.mesh.vertices.size(), read_color(section));
  const Eigen::AngleAxisd upright(std::numbers::pi, Eigen::Vector3d::UnitX());
  object.model_from_object =
      Eigen::Translation3d(vector(section, "at")) * turned(vector(section, "turn")) * upright;
  return object;
}

Augmentation make_augmentation(const Parameters& section, Device& device, const Rig& rig) {
  return {device, read_object(section), rig, section.real("tolerance")};
}

}  // namespace pliant
