#include "experiments/datasets/virtual_camera.h"

#include <utility>

namespace pliant {

ParameterTable with_camera(std::vector<Parameter> rows) {
  rows.push_back(integer("image_width", 640).unit("pixel").range(1, 8192).doc("columns of the images"));
  rows.push_back(integer("image_height", 480).unit("pixel").range(1, 8192).doc("rows of the images"));
  rows.push_back(real("focal_length", 525).unit("pixel").above(0).doc("focal length in x and y"));
  rows.push_back(
      real("cx").unit("pixel").optional().doc("principal point in x; the middle of the image by default"));
  rows.push_back(
      real("cy").unit("pixel").optional().doc("principal point in y; the middle of the image by default"));
  return ParameterTable(std::move(rows));
}

Camera virtual_camera(const Parameters& section) {
  const auto width = static_cast<int>(section.integer("image_width"));
  const auto height = static_cast<int>(section.integer("image_height"));
  const double focal_length = section.real("focal_length");
  return {focal_length,
          focal_length,
          section.has("cx") ? section.real("cx") : (width - 1) / 2.0,
          section.has("cy") ? section.real("cy") : (height - 1) / 2.0,
          width,
          height};
}

}  // namespace pliant
