#include "framework/io/surface_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "framework/core/error.h"
#include "framework/io/file.h"
#include "framework/io/obj_reader.h"
#include "framework/io/ply_reader.h"

namespace pliant {
namespace {

bool is_named_obj(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return extension == ".obj";
}

}  // namespace

SurfaceMesh read_surface_mesh(const std::string& path, double unit) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  if (!is_ply(bytes) && !is_named_obj(path))
    throw DataError(path + ": neither a PLY file, which begins with 'ply', nor one that is named .obj");
  SurfaceMesh mesh = is_ply(bytes) ? read_ply(bytes, path, unit) : read_obj(bytes, path, unit);
  if (mesh.triangles.empty())
    throw DataError(
        fmt::format("{}: {} vertices without faces; expected a surface of triangles or polygons, no points "
                    "alone",
                    path, mesh.vertices.size()));
  return mesh;
}

void add_polygon(const std::vector<int>& corners, std::vector<Eigen::Vector3i>& triangles) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Eigen::Vector3i triangle(corners[0], corners[i], corners[i + 1]);
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      triangles.push_back(triangle);
  }
}

}  // namespace pliant
