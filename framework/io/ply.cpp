#include "framework/io/ply.h"

#include <fmt/format.h>

#include <cstdint>
#include <stdexcept>

#include "framework/io/file.h"
#include "framework/io/little_endian.h"

namespace pliant {
namespace {

constexpr Rgb neutral_grey{180, 180, 180};

std::string header(const PlySurface& ply) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment millimetres, camera frame\nelement vertex {}\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property int u\nproperty int v\nproperty float error\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n{}"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
      ply.surface.size(), ply.matched.empty() ? "" : "property uchar matched\n", ply.triangles.size());
}

void append_vertex(std::vector<std::uint8_t>& bytes, const PlySurface& ply, std::size_t index) {
  const Surface& surface = ply.surface;
  append(bytes, surface.points[index]);
  append(bytes, surface.normals[index]);
  append(bytes, static_cast<std::int32_t>(surface.pixels[index].x()));
  append(bytes, static_cast<std::int32_t>(surface.pixels[index].y()));
  append(bytes, ply.errors[index]);
  const Rgb color = surface.colors.empty() ? neutral_grey : surface.colors[index];
  bytes.insert(bytes.end(), {color.r, color.g, color.b});
  if (!ply.matched.empty()) bytes.push_back(ply.matched[index]);
}

void check_lengths(const PlySurface& ply) {
  const std::size_t count = ply.surface.points.size();
  const bool fits = ply.surface.normals.size() == count && ply.surface.pixels.size() == count &&
                    ply.errors.size() == count &&
                    (ply.surface.colors.empty() || ply.surface.colors.size() == count) &&
                    (ply.matched.empty() || ply.matched.size() == count);
  if (!fits) throw std::invalid_argument("the lists of a PLY surface differ in length");
}

}  // namespace

void write_ply(const std::string& path, const PlySurface& ply) {
  check_lengths(ply);
  const std::string head = header(ply);
  std::vector<std::uint8_t> bytes(head.begin(), head.end());
  bytes.reserve(bytes.size() + 40 * ply.surface.size() + 13 * ply.triangles.size());
  for (std::size_t i = 0; i < ply.surface.size(); ++i) append_vertex(bytes, ply, i);
  for (const Eigen::Vector3i& triangle : ply.triangles) {
    bytes.push_back(3);
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<std::int32_t>(triangle[i]));
  }
  write_file(path, bytes);
}

}  // namespace pliant
