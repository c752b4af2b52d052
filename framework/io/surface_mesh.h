#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/geometry/image.h"

namespace pliant {

/// Triangles over vertices, as a file of a scanned surface holds them.
struct SurfaceMesh {
  std::vector<Eigen::Vector3f> vertices;   ///< mm, in the file's own frame
  std::vector<Eigen::Vector3i> triangles;  ///< indices of vertices
  std::vector<Rgb> colors;                 ///< of every vertex; empty where the file has none
};

/// Reads a surface from a PLY or OBJ file, whichever its first line or the end of its name says. A unit of
/// the file is so many mm as `unit`. Polygons become fans of triangles around their first corner; triangles
/// that name a vertex twice are left out. Throws DataError naming the file and what is wrong where in it;
/// also when it has no faces, as point clouds do.
SurfaceMesh read_surface_mesh(const std::string& path, double unit);

/// The triangles of one polygon, by its corners in order.
void add_polygon(const std::vector<int>& corners, std::vector<Eigen::Vector3i>& triangles);

}  // namespace pliant
