#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "framework/core/parameters.h"
#include "framework/io/intrinsics.h"

namespace pliant {

/// Where a source of files has its camera from: a file, or the numbers themselves.
struct CameraChoice {
  std::string file;              ///< with a camera matrix; empty: the numbers count
  Camera numbers;                ///< without a size
  std::string place = "camera";  ///< where the numbers were given, for errors
};

/// `rows` and those of a camera: `intrinsics`, a file, or `fx`, `fy`, `cx` and `cy`.
ParameterTable with_intrinsics(std::vector<Parameter> rows);

/// What a section of such a table says; none where it says nothing. Throws ConfigError when it gives both, or
/// some of the numbers only.
std::optional<CameraChoice> camera_choice(const Parameters& section);

/// The camera of images of this size. Throws DataError as read_intrinsics and check_intrinsics do.
Intrinsics intrinsics_of(const CameraChoice& choice, int width, int height);

/// A motion that a parameter gives as a 4x4 matrix row by row, mm. Throws ConfigError unless it is rigid.
Eigen::Isometry3d rigid_matrix(const Parameters& section, const std::string& name);

/// What is odd about a colour camera's place, a line each that begins with `name`: cameras that stand closer
/// than their lenses could were probably measured in metres.
std::vector<std::string> doubts_about_distance(const Eigen::Isometry3d& color_from_depth,
                                               const std::string& name);

}  // namespace pliant
