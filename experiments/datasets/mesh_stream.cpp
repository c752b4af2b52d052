#include "experiments/datasets/mesh_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "experiments/datasets/mesh_size.h"
#include "framework/core/error.h"
#include "framework/geometry/point_set.h"

namespace pliant {
namespace {

DepthImage depth_image(const Array<float>& depth, const Camera& camera) {
  DepthImage image(camera.width, camera.height);
  depth.copy_to(image.data());
  return image;
}

struct OrientedPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  // of any length
};

/// What a pixel of a view shows, when the vertices are where `vertices` has them, x y z each; NaN where it
/// shows nothing.
OrientedPoint carried(const MeshView& from, const Eigen::Vector2i& pixel,
                      const std::vector<Eigen::Vector3i>& triangles, const std::vector<float>& vertices) {
  const auto at = static_cast<std::size_t>(pixel.y() * from.camera.width + pixel.x());
  const int triangle = from.triangles.host()[at];
  if (triangle < 0) {
    const auto unknown = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return {unknown, unknown};
  }
  const auto corner = [&](int i) -> Eigen::Vector3d {
    const auto vertex = static_cast<std::size_t>(triangles[static_cast<std::size_t>(triangle)][i]);
    return Eigen::Map<const Eigen::Vector3f>(&vertices[3 * vertex]).cast<double>();
  };
  const Eigen::Vector3d second = corner(1) - corner(0);
  const Eigen::Vector3d third = corner(2) - corner(0);
  const float* shares = &from.shares.host()[2 * at];
  return {corner(0) + shares[0] * second + shares[1] * third, second.cross(third)};
}

}  // namespace

MeshStream::MeshStream(std::shared_ptr<const MeshScene> scene, Device& device, std::uint64_t seed)
    : scene_(std::move(scene)),
      device_(device),
      renderer_(device, scene_->mesh.triangles, scene_->mesh.vertices.size()),
      sensor_(scene_->sensor, scene_->rig.depth, seed),
      rest_(flatten(scene_->mesh.deform(scene_->mesh.rest()))) {}

MeshStream::Seen MeshStream::see(int number) const {
  const auto vertices = scene_->vertices_at(scene_->time_of(number));
  if (is_inside(Eigen::Vector3d::Zero(), vertices, scene_->mesh.triangles))
    throw DataError(fmt::format("{}: the camera is inside the mesh in frame {}; {}", scene_->what, number,
                                described_size(scene_->box)));
  Array<float> points = flatten(vertices);
  MeshView view = renderer_.render(points, scene_->rig.depth);
  return {number, std::move(points), std::move(view)};
}

const MeshStream::Seen& MeshStream::latest(int number) const {
  if (!latest_ || latest_->number != number) latest_ = see(number);
  return *latest_;
}

const MeshStream::Seen& MeshStream::first(int number) const {
  if (!first_ || first_->number != number) first_ = see(number);
  return *first_;
}

std::optional<Frame> MeshStream::next() {
  if (given_ == scene_->frames) return std::nullopt;
  ++given_;
  const Seen& seen = latest(given_);
  Frame frame;
  frame.time = scene_->time_of(given_);
  frame.color = color_of(seen);
  frame.depth = depth_image(seen.view.depth, scene_->rig.depth);
  if (given_ == 1 || scene_->frames == 2) check_is_seen(frame.depth, given_);
  if (scene_->sensor.is_on())
    frame.depth = depth_image(sensor_.sense(device_, seen.view.depth, static_cast<std::uint32_t>(given_)),
                              scene_->rig.depth);
  if (given_ == 1) first_ = std::exchange(latest_, std::nullopt);
  return frame;
}

ColorImage MeshStream::color_of(const Seen& seen) const {
  const Rig& rig = scene_->rig;
  const auto painted = [&](const MeshView& view) {
    return read_colors(scene_->color.paint(device_, view, renderer_.interpolate(view, rest_)), view.camera);
  };
  if (!rig.color) return painted(seen.view);
  std::vector<Eigen::Vector3f> vertices = unflatten(seen.vertices);
  const Eigen::Isometry3f color_from_depth = rig.color_from_depth.cast<float>();
  for (Eigen::Vector3f& vertex : vertices) vertex = color_from_depth * vertex;
  return painted(renderer_.render(flatten(vertices), *rig.color));
}

void MeshStream::check_is_seen(const DepthImage& exact, int number) const {
  const auto& pixels = exact.pixels();
  if (std::any_of(pixels.begin(), pixels.end(), [](float depth) { return depth > 0; })) return;
  throw DataError(
      fmt::format("{}: no pixel of the camera sees the mesh in frame {}; {}, and its middle {:.6g} mm from "
                  "the first camera",
                  scene_->what, number, described_size(scene_->box), scene_->distance));
}

std::optional<PairTruth> MeshStream::truth(int number) const {
  if (number < 2 || number > scene_->frames) return std::nullopt;
  const Seen& target = latest(number);
  TrueMotion motion = renderer_.move(first(1).view, target.vertices, target.view).read(scene_->rig.depth);
  return PairTruth{std::move(motion.scene_flow), std::move(motion.optical_flow), std::move(motion.visible)};
}

DepthImage MeshStream::exact_depth(int number) const {
  return depth_image(latest(number).view.depth, scene_->rig.depth);
}

std::optional<Eigen::Isometry3d> MeshStream::camera_pose(int number) const {
  return scene_->followed_from_camera(scene_->time_of(number));
}

std::optional<Mesh> MeshStream::surface(int number) const {
  Mesh mesh;
  for (const Eigen::Vector3d& vertex : scene_->vertices_at(scene_->time_of(number)))
    mesh.vertices.push_back(vertex.cast<float>());
  mesh.triangles = scene_->mesh.triangles;
  return mesh;
}

std::optional<TruePoints> MeshStream::points_of(int first, const std::vector<Eigen::Vector2i>& pixels,
                                                int number) const {
  const MeshView& from = this->first(first).view;
  const std::vector<float>& vertices = latest(number).vertices.host();
  const DepthImage depth = exact_depth(number);
  const Camera& camera = scene_->rig.depth;
  TruePoints points;
  for (const Eigen::Vector2i& pixel : pixels) {
    const OrientedPoint now = carried(from, pixel, scene_->mesh.triangles, vertices);
    points.positions.push_back(now.position.cast<float>());
    points.visible.push_back(now.position.z() > 0 && is_shown(now.position, now.normal, camera, depth));
  }
  return points;
}

}  // namespace pliant
