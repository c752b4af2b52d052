#include "framework/tracking/folded_cells.h"

#include <array>

#include "framework/tracking/folded_cells.cl.embed.h"

namespace pliant {

int count_folded_cells(Device& device, const SurfaceMap& moved) {
  auto kernel = device.kernel(embedded::framework_tracking_folded_cells_cl, "count_folded");
  const PixelWindow& window = moved.window;
  Array<int> folded(std::vector<int>(1, 0));
  device.run("folds", kernel, window.size(), 64, cl_int2{{window.width, window.height}},
             pinhole(moved.camera), moved.points().device(device), moved.normals().device(device),
             folded.write_device(device));
  return folded.host().front();
}

namespace {

float goes_around(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool is_folded(const SurfaceMap& moved, int left, int top) {
  std::array<Eigen::Vector2f, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2i pixel(left + i % 2, top + i / 2);
    const Eigen::Vector3f point = finite_or_none(moved, moved.points(), pixel);
    const Eigen::Vector3f normal = finite_or_none(moved, moved.normals(), pixel);
    if (!(point.z() > 0 && point.dot(normal) < 0)) return false;
    corners[static_cast<std::size_t>(i)] = moved.camera.project(point.cast<double>()).cast<float>();
  }
  return goes_around(corners[0], corners[1], corners[2]) < 0 ||
         goes_around(corners[3], corners[2], corners[1]) < 0;
}

}  // namespace

int count_folded_cells_reference(const SurfaceMap& moved) {
  int folded = 0;
  const PixelWindow& window = moved.window;
  for (int v = window.top; v + 1 < window.top + window.height; ++v)
    for (int u = window.left; u + 1 < window.left + window.width; ++u)
      if (is_folded(moved, u, v)) ++folded;
  return folded;
}

}  // namespace pliant
