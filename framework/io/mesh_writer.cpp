#include "framework/io/mesh_writer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "framework/io/file.h"
#include "framework/io/glb_writer.h"
#include "framework/io/little_endian.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;

/// A file with the mesh, unless it has no triangles.
GlbWriter glb_of(const Mesh& mesh) {
  constexpr double metre = 0.001;
  GlbWriter glb;
  glb.json.update(
      {{"scene", 0},
       {"scenes", {{{"nodes", {0}}}}},
       {"nodes", {{{"name", "model"}, {"rotation", {1, 0, 0, 0}}, {"scale", {metre, metre, metre}}}}}});
  if (mesh.triangles.empty()) return glb;
  const std::size_t positions = glb.add_positions(mesh.vertices);
  glb.json["nodes"][0]["mesh"] = 0;
  glb.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", positions}}}, {"indices", glb.add_triangles(mesh.triangles)}}}}}};
  return glb;
}

void add_targets(const Mesh& mesh, GlbWriter& glb) {
  ordered_json targets;
  for (const MorphTarget& target : mesh.targets)
    targets.push_back({{"POSITION", glb.add_positions(target.displacements)}});
  ordered_json& description = glb.json["meshes"][0];
  description["primitives"][0]["targets"] = targets;
  description["extras"] = {{"targetNames", mesh.target_names()}};
}

void add_animation(const Track& weights, GlbWriter& glb) {
  const std::size_t times = glb.add_scalars({weights.times.begin(), weights.times.end()});
  const std::size_t values = glb.add_scalars({weights.values.begin(), weights.values.end()});
  const ordered_json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
  const ordered_json sampler = {{"input", times}, {"interpolation", "LINEAR"}, {"output", values}};
  glb.json["animations"] = ordered_json::array(
      {{{"channels", ordered_json::array({channel})}, {"samplers", ordered_json::array({sampler})}}});
}

}  // namespace

void write_mesh_ply(const std::string& path, const Mesh& mesh) {
  const std::string head = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment millimetres\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  std::vector<std::uint8_t> bytes(head.begin(), head.end());
  for (const Eigen::Vector3f& vertex : mesh.vertices) append(bytes, vertex);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<std::int32_t>(triangle[i]));
  }
  write_file(path, bytes);
}

void write_glb(const std::string& path, const Mesh& mesh) { glb_of(mesh).write(path); }

void write_animated_glb(const std::string& path, const Mesh& mesh, const Track& weights) {
  if (weights.width != mesh.targets.size() || weights.values.size() != weights.times.size() * weights.width ||
      weights.interpolation != Track::Interpolation::linear)
    throw std::invalid_argument("expected a linear track of the weights of all morph targets");
  GlbWriter glb = glb_of(mesh);
  if (!mesh.triangles.empty() && !mesh.targets.empty()) {
    add_targets(mesh, glb);
    add_animation(weights, glb);
  }
  glb.write(path);
}

}  // namespace pliant
