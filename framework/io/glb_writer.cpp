#include "framework/io/glb_writer.h"

#include <algorithm>
#include <utility>

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

ordered_json coordinates(const Eigen::Vector3f& vector) { return {vector.x(), vector.y(), vector.z()}; }

void append_chunk(Bytes& file, std::uint32_t type, Bytes content, std::uint8_t padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  append(file, static_cast<std::uint32_t>(content.size()));
  append(file, type);
  file.insert(file.end(), content.begin(), content.end());
}

}  // namespace

/// Of the last `bytes` bytes.
ordered_json& GlbWriter::add_accessor(std::size_t bytes, int component_type, std::size_t count,
                                      const char* type) {
  accessors_.push_back(
      {{"bufferView", views_.size()}, {"componentType", component_type}, {"count", count}, {"type", type}});
  views_.push_back({{"buffer", 0}, {"byteOffset", binary_.size() - bytes}, {"byteLength", bytes}});
  return accessors_.back();
}

std::size_t GlbWriter::add_positions(const std::vector<Eigen::Vector3f>& positions) {
  Eigen::Vector3f least = positions.front();
  Eigen::Vector3f greatest = least;
  for (const Eigen::Vector3f& position : positions) {
    append(binary_, position);
    least = least.cwiseMin(position);
    greatest = greatest.cwiseMax(position);
  }
  ordered_json& accessor = add_accessor(12 * positions.size(), float_type, positions.size(), "VEC3");
  accessor["min"] = coordinates(least);
  accessor["max"] = coordinates(greatest);
  views_.back()["target"] = vertex_target;
  return accessors_.size() - 1;
}

std::size_t GlbWriter::add_triangles(const std::vector<Eigen::Vector3i>& triangles) {
  for (const Eigen::Vector3i& triangle : triangles)
    for (int i = 0; i < 3; ++i) append(binary_, static_cast<std::int32_t>(triangle[i]));
  add_accessor(12 * triangles.size(), unsigned_int_type, 3 * triangles.size(), "SCALAR");
  views_.back()["target"] = index_target;
  return accessors_.size() - 1;
}

std::size_t GlbWriter::add_scalars(const std::vector<float>& values) {
  for (const float value : values) append(binary_, value);
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  ordered_json& accessor = add_accessor(4 * values.size(), float_type, values.size(), "SCALAR");
  accessor["min"] = ordered_json::array({*least});
  accessor["max"] = ordered_json::array({*greatest});
  return accessors_.size() - 1;
}

void GlbWriter::write(const std::string& path) const {
  ordered_json whole = json;
  if (!binary_.empty()) {
    whole["buffers"] = {{{"byteLength", binary_.size()}}};
    whole["bufferViews"] = views_;
    whole["accessors"] = accessors_;
  }
  const std::string text = whole.dump();
  Bytes chunks;
  append_chunk(chunks, json_chunk, {text.begin(), text.end()}, ' ');
  if (!binary_.empty()) append_chunk(chunks, binary_chunk, binary_, 0);
  Bytes file;
  append(file, magic);
  append(file, std::uint32_t{2});
  append(file, static_cast<std::uint32_t>(12 + chunks.size()));
  file.insert(file.end(), chunks.begin(), chunks.end());
  write_file(path, file);
}

}  // namespace pliant
