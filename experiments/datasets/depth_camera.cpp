#include "experiments/datasets/depth_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/rig.h"

namespace pliant {
namespace {

constexpr std::array<const char*, 4> numbers{"fx", "fy", "cx", "cy"};

}  // namespace

ParameterTable with_intrinsics(std::vector<Parameter> rows) {
  rows.push_back(path("intrinsics").optional().doc("text file with the 3x3 or 4x4 camera matrix in pixels"));
  rows.push_back(real("fx").unit("pixel").above(0).optional().doc("focal length in x, without such a file"));
  rows.push_back(real("fy").unit("pixel").above(0).optional().doc("focal length in y, likewise"));
  rows.push_back(real("cx").unit("pixel").optional().doc("principal point in x, likewise"));
  rows.push_back(real("cy").unit("pixel").optional().doc("principal point in y, likewise"));
  return ParameterTable(std::move(rows));
}

std::optional<CameraChoice> camera_choice(const Parameters& section) {
  const auto is_given = [&](const char* name) { return section.has(name); };
  const bool has_some = std::any_of(numbers.begin(), numbers.end(), is_given);
  if (!has_some && !section.has("intrinsics")) return std::nullopt;
  if (has_some && section.has("intrinsics"))
    throw ConfigError(section.place() + ": both 'intrinsics' and numbers of the camera are given");
  if (section.has("intrinsics")) return CameraChoice{section.text("intrinsics"), {}, ""};
  const auto missing = std::find_if_not(numbers.begin(), numbers.end(), is_given);
  if (missing != numbers.end())
    throw ConfigError(
        fmt::format("{}: a camera has fx, fy, cx and cy; '{}' is missing", section.place(), *missing));
  return CameraChoice{"",
                      {section.real("fx"), section.real("fy"), section.real("cx"), section.real("cy"), 0, 0},
                      section.place()};
}

Intrinsics intrinsics_of(const CameraChoice& choice, int width, int height) {
  if (!choice.file.empty()) return read_intrinsics(choice.file, width, height);
  Camera camera = choice.numbers;
  camera.width = width;
  camera.height = height;
  return check_intrinsics(camera, choice.place);
}

Eigen::Isometry3d rigid_matrix(const Parameters& section, const std::string& name) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix(section.reals(name).data());
  if (!is_rigid(matrix))
    throw ConfigError(fmt::format(
        "{}: '{}' is no rigid motion; expected a 4x4 matrix row by row: [R, t; 0 0 0 1] with a rotation R "
        "and t in mm",
        section.place(), name));
  return Eigen::Isometry3d(matrix);
}

std::vector<std::string> doubts_about_distance(const Eigen::Isometry3d& color_from_depth,
                                               const std::string& name) {
  const double distance = color_from_depth.translation().norm();
  if (distance == 0 || distance >= 1) return {};
  return {fmt::format(
      "{}: 'color_from_depth' puts the cameras {:g} mm apart; if it counts in metres, write {:g} mm", name,
      distance, 1000 * distance)};
}

}  // namespace pliant
