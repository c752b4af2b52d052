#include "framework/model/reintegration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "framework/deformation/skinning.h"
#include "framework/deformation/warp.h"
#include "framework/model/reintegration.cl.embed.h"

namespace pliant {
namespace {

cl::Kernel drawing_kernel(Device& device, const std::string& name) {
  static const std::string source = with_surface_map(embedded::framework_model_reintegration_cl);
  static const std::string options = fmt::format("-DNO_DEPTH={:e}f", DepthMap::no_depth);
  return device.kernel(source, name, options);
}

}  // namespace

void draw_depth(Device& device, const SurfaceMap& map, DepthMap& drawn) {
  const PixelWindow& window = map.window;
  auto clear = drawing_kernel(device, "clear_depth");
  auto draw = drawing_kernel(device, "draw_cells");
  const Buffer& depth = drawn.depth.write_device(device);
  device.run("reintegrate", clear, drawn.depth.size(), 64, static_cast<cl_int>(drawn.depth.size()), depth);
  device.run("reintegrate", draw, window.size(), 64,
             cl_int4{{window.left, window.top, window.width, window.height}}, pinhole(map.camera),
             steepest_cell, static_cast<cl_int>(drawn.stride), static_cast<cl_int>(drawn.offset(0, 0)),
             map.points().device(device), depth);
}

Reintegration::Reintegration(Device& device, std::unique_ptr<ReferenceModel> model, int weight)
    : device_(device), model_(std::move(model)), weight_(weight), drawn_(PixelWindow{}) {}

void Reintegration::integrate(const DepthMap& depth, const Camera& camera,
                              const Eigen::Isometry3d& camera_from_model) {
  model_->integrate(depth, camera, camera_from_model);
}

const SurfaceMap& Reintegration::view(const Camera& camera, const PixelWindow& window,
                                      const Eigen::Isometry3d& camera_from_model) {
  view_ = &model_->raycast(camera, window, camera_from_model);
  return *view_;
}

DeformationStart Reintegration::start() { return {*view_, {}, {}}; }

void Reintegration::deform(const ModelDeformation& deformation) {
  const SurfaceMap& moved = deformation.moved;
  if (!(drawn_.window == moved.window)) drawn_ = DepthMap(moved.window);
  draw_depth(device_, moved, drawn_);
  model_->integrate(drawn_, moved.camera, deformation.camera_from_model_after, weight_);
  if (!followed_.empty()) move_followed(deformation);
}

void Reintegration::follow(const Array<float>& points) { followed_ = points.clone(); }

void Reintegration::move_followed(const ModelDeformation& deformation) {
  const EmbeddedGraph& graph = deformation.graph;
  PointSet points = no_points(device_, followed_.size() / 3);  // their normals are not asked for
  points.points = std::move(followed_);
  PointSet seen = no_points(device_, points.points.size() / 3);
  move_points(device_, points, deformation.camera_from_model, seen);
  const Influences influences =
      compute_influences(device_, seen.points, graph.positions, deformation.nearest_nodes);
  warp_points(device_, seen.points, influences, graph.node_points, deformation.affine, points.points);
  move_points(device_, points, deformation.camera_from_model_after.inverse(), seen);
  followed_ = std::move(seen.points);
}

namespace {

struct Corner {
  Eigen::Vector2f pixel;
  float z;
};

float area_of(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

void draw_triangle(const Corner& a, const Corner& b, const Corner& c, DepthMap& drawn) {
  const float whole = area_of(a.pixel, b.pixel, c.pixel);
  if (!(whole > 0)) return;
  const PixelWindow& window = drawn.window;
  for (int row = 0; row < window.height; ++row) {
    for (int column = 0; column < window.width; ++column) {
      const Eigen::Vector2f p(static_cast<float>(window.left + column), static_cast<float>(window.top + row));
      const std::array shares{area_of(b.pixel, c.pixel, p), area_of(c.pixel, a.pixel, p),
                              area_of(a.pixel, b.pixel, p)};
      if (std::any_of(shares.begin(), shares.end(), [](float share) { return share < 0; })) continue;
      float& depth = drawn.depth.write_host()[drawn.offset(column, row)];
      depth = std::min(depth, whole / (shares[0] / a.z + shares[1] / b.z + shares[2] / c.z));
    }
  }
}

}  // namespace

void draw_depth_reference(const SurfaceMap& map, DepthMap& drawn) {
  auto& depth = drawn.depth.write_host();
  std::fill(depth.begin(), depth.end(), DepthMap::no_depth);
  const PixelWindow& window = map.window;
  for (int row = 0; row + 1 < window.height; ++row) {
    for (int column = 0; column + 1 < window.width; ++column) {
      std::array<Corner, 4> corners;
      float nearest = DepthMap::no_depth;
      float farthest = 0;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector2i pixel(window.left + column + i % 2, window.top + row + i / 2);
        const Eigen::Vector3f point = finite_or_none(map, map.points(), pixel);
        nearest = std::min(nearest, point.z());
        farthest = std::max(farthest, point.z());
        corners[static_cast<std::size_t>(i)] = {map.camera.project(point.cast<double>()).cast<float>(),
                                                point.z()};
      }
      if (!(nearest > 0) ||
          !(farthest - nearest <= steepest_cell * nearest / static_cast<float>(map.camera.fx)))
        continue;
      draw_triangle(corners[0], corners[1], corners[2], drawn);
      draw_triangle(corners[3], corners[2], corners[1], drawn);
    }
  }
}

}  // namespace pliant
