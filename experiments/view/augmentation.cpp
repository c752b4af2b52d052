#include "experiments/view/augmentation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "framework/core/error.h"
#include "framework/geometry/color_at_depth.h"
#include "framework/geometry/point_set.h"

namespace pliant {
namespace {

/// Of what is seen edge-on, as a share of what faces the light.
constexpr float ambient = 0.3F;

/// The sum of the normals of the triangles around each vertex, each as long as twice its area.
std::vector<Eigen::Vector3f> vertex_normals(const std::vector<Eigen::Vector3f>& vertices,
                                            const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<Eigen::Vector3f> normals(vertices.size(), Eigen::Vector3f::Zero());
  const auto at = [](auto& list, int index) -> auto& { return list[static_cast<std::size_t>(index)]; };
  for (const Eigen::Vector3i& triangle : triangles) {
    const Eigen::Vector3f& corner = at(vertices, triangle[0]);
    const Eigen::Vector3f normal =
        (at(vertices, triangle[1]) - corner).cross(at(vertices, triangle[2]) - corner);
    for (int k = 0; k < 3; ++k) at(normals, triangle[k]) += normal;
  }
  return normals;
}

/// How bright a point is in the light of the camera that is at the origin.
float brightness(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  const float lengths = point.norm() * normal.norm();
  return lengths > 0 ? ambient + (1 - ambient) * std::abs(point.dot(normal)) / lengths : ambient;
}

/// The bounding window of the pixels that show a triangle; empty where none does.
PixelWindow window_of(const MeshView& view) {
  const PixelWindow image = whole_image(view.camera);
  Eigen::AlignedBox2i box;
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u)
      if (view.triangles.host()[image.offset(u, v)] >= 0) box.extend(Eigen::Vector2i(u, v));
  if (box.isEmpty()) return {};
  return {box.min().x(), box.min().y(), box.sizes().x() + 1, box.sizes().y() + 1};
}

Rgb to_color(const float* rgb) {
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
  };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
}

}  // namespace

Augmentation::Augmentation(Device& device, Object object, const Rig& rig, double tolerance)
    : object_(std::move(object)),
      rig_(rig),
      tolerance_(tolerance),
      renderer_(device, object_.mesh.triangles, object_.mesh.vertices.size()) {
  if (object_.mesh.colors.size() != object_.mesh.vertices.size())
    throw std::invalid_argument("the object has not as many colours as vertices");
}

Array<float> Augmentation::shaded(const std::vector<Eigen::Vector3f>& vertices) const {
  const auto normals = vertex_normals(vertices, object_.mesh.triangles);
  std::vector<Eigen::Vector3f> colors;
  colors.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Rgb& color = object_.mesh.colors[i];
    colors.push_back(brightness(vertices[i], normals[i]) * Eigen::Vector3f(color.r, color.g, color.b));
  }
  return flatten(colors);
}

ColorImage Augmentation::draw(const Frame& frame, const Eigen::Isometry3d& camera_from_model) const {
  if (frame.color.empty()) throw DataError("augmentation: the frames have no colour to draw over");
  Eigen::Affine3d camera_from_object = camera_from_model * object_.model_from_object;
  if (rig_.color) camera_from_object = rig_.color_from_depth * camera_from_object;
  std::vector<Eigen::Vector3f> vertices;
  vertices.reserve(object_.mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : object_.mesh.vertices)
    vertices.emplace_back((camera_from_object * vertex.cast<double>()).cast<float>());
  const MeshView view = renderer_.render(flatten(vertices), rig_.color.value_or(rig_.depth));
  const Array<float> colors = renderer_.interpolate(view, shaded(vertices));
  ColorImage image = frame.color;
  const PixelWindow window = window_of(view);
  if (window.size() == 0) return image;
  const DepthImage measured = depth_at_color(frame.depth, rig_, window);
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (view.triangles.host()[i] < 0) continue;
    const float before = measured.data()[i];
    if (is_depth(before) && view.depth.host()[i] > before + tolerance_) continue;
    image.data()[i] = to_color(colors.host().data() + 3 * i);
  }
  return image;
}

}  // namespace pliant
