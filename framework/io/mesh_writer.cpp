#include "framework/io/mesh_writer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "framework/io/file.h"
#include "framework/io/little_endian.h"

namespace pliant {
namespace {

using nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

// Of the glTF 2.0 specification.
constexpr std::uint32_t magic = 0x46546C67;
constexpr std::uint32_t json_chunk = 0x4E4F534A;
constexpr std::uint32_t binary_chunk = 0x004E4942;
constexpr int float_type = 5126;
constexpr int unsigned_int_type = 5125;
constexpr int vertex_target = 34962;
constexpr int index_target = 34963;

/// Least and greatest of each coordinate, as a reader must be told.
ordered_json bounds(const Mesh& mesh, bool greatest) {
  Eigen::Vector3f bound = mesh.vertices.front();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    bound = greatest ? bound.cwiseMax(vertex).eval() : bound.cwiseMin(vertex).eval();
  return {bound.x(), bound.y(), bound.z()};
}

ordered_json describe(const Mesh& mesh, std::size_t vertex_bytes, std::size_t index_bytes) {
  constexpr double metre = 0.001;
  ordered_json json = {
      {"asset", {{"version", "2.0"}, {"generator", "Pliant"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"name", "model"}, {"rotation", {1, 0, 0, 0}}, {"scale", {metre, metre, metre}}}}}};
  if (mesh.triangles.empty()) return json;
  json["nodes"][0]["mesh"] = 0;
  json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
  json["buffers"] = {{{"byteLength", vertex_bytes + index_bytes}}};
  json["bufferViews"] = {
      {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", vertex_bytes}, {"target", vertex_target}},
      {{"buffer", 0}, {"byteOffset", vertex_bytes}, {"byteLength", index_bytes}, {"target", index_target}}};
  json["accessors"] = {{{"bufferView", 0},
                        {"componentType", float_type},
                        {"count", mesh.vertices.size()},
                        {"type", "VEC3"},
                        {"min", bounds(mesh, false)},
                        {"max", bounds(mesh, true)}},
                       {{"bufferView", 1},
                        {"componentType", unsigned_int_type},
                        {"count", 3 * mesh.triangles.size()},
                        {"type", "SCALAR"}}};
  return json;
}

void append_chunk(Bytes& file, std::uint32_t type, Bytes content, std::uint8_t padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  append(file, static_cast<std::uint32_t>(content.size()));
  append(file, type);
  file.insert(file.end(), content.begin(), content.end());
}

}  // namespace

void write_mesh_ply(const std::string& path, const Mesh& mesh) {
  const std::string head = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment millimetres\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  Bytes bytes(head.begin(), head.end());
  for (const Eigen::Vector3f& vertex : mesh.vertices) append(bytes, vertex);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<std::int32_t>(triangle[i]));
  }
  write_file(path, bytes);
}

void write_glb(const std::string& path, const Mesh& mesh) {
  Bytes binary;
  for (const Eigen::Vector3f& vertex : mesh.vertices) append(binary, vertex);
  const std::size_t vertex_bytes = binary.size();
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int i = 0; i < 3; ++i) append(binary, static_cast<std::int32_t>(triangle[i]));
  const std::string text = describe(mesh, vertex_bytes, binary.size() - vertex_bytes).dump();

  Bytes chunks;
  append_chunk(chunks, json_chunk, {text.begin(), text.end()}, ' ');
  if (!mesh.triangles.empty()) append_chunk(chunks, binary_chunk, std::move(binary), 0);
  Bytes file;
  append(file, magic);
  append(file, std::uint32_t{2});
  append(file, static_cast<std::uint32_t>(12 + chunks.size()));
  file.insert(file.end(), chunks.begin(), chunks.end());
  write_file(path, file);
}

}  // namespace pliant
