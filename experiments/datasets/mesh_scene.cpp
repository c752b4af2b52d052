#include "experiments/datasets/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "framework/geometry/bounding_box.h"

namespace pliant {
namespace {

/// From the mesh's frame (y up, looking along +z) to the scene's, the middle of the mesh in the origin.
Eigen::Affine3d facing_the_camera(const Eigen::Vector3d& middle) {
  return Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()) * Eigen::Translation3d(-middle);
}

/// The solid angle under which a triangle is seen from the origin, positive from its inside [Van Oosterom,
/// Strackee 1983].
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double x = a.norm();
  const double y = b.norm();
  const double z = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y);
}

}  // namespace

SceneKey between(const SceneKey& from, const SceneKey& to, double share) {
  return {from.time + share * (to.time - from.time), between(from.pose, to.pose, share),
          between(from.motion, to.motion, share), between(from.camera, to.camera, share)};
}

double MeshScene::time_of(int frame) const { return keys.front().time + (frame - 1) / frame_rate; }

SceneKey MeshScene::state_at(double time) const {
  const auto after =
      std::find_if(keys.begin(), keys.end(), [&](const SceneKey& key) { return key.time > time; });
  if (after == keys.begin()) return keys.front();
  if (after == keys.end()) return keys.back();
  const SceneKey& before = *(after - 1);
  const double way = (time - before.time) / (after->time - before.time);
  return between(before, *after, way * way * (3 - 2 * way));
}

MeshPose MeshScene::beneath_at(double time) const {
  if (!animation) return mesh.rest();
  const double way = (time - keys.front().time) / (time_of(frames) - keys.front().time);
  return animation->animation.pose(mesh, animation->begin + way * (animation->end - animation->begin));
}

std::vector<Eigen::Vector3d> MeshScene::vertices_at(double time) const {
  const SceneKey state = state_at(time);
  const Eigen::Affine3d placed = state.camera.camera_from_scene() * Eigen::Translation3d(0, 0, distance) *
                                 state.motion.transform() * facing_the_camera(box.center());
  std::vector<Eigen::Vector3d> vertices = mesh.deform(on_top(on_top(beneath_at(time), base), state.pose));
  for (Eigen::Vector3d& vertex : vertices) vertex = placed * vertex;
  return vertices;
}

Eigen::Isometry3d MeshScene::followed_from_camera(double time) const {
  const SceneKey state = state_at(time);
  const Eigen::Translation3d middle(0, 0, distance);
  return middle * state.motion.transform().inverse() * middle.inverse() *
         state.camera.camera_from_scene().inverse();
}

Eigen::AlignedBox3d box_around(const Mesh& mesh, const FigurePose& base) {
  return box_around(mesh.deform(on_top(mesh.rest(), base)));
}

bool is_inside(const Eigen::Vector3d& point, const std::vector<Eigen::Vector3d>& vertices,
               const std::vector<Eigen::Vector3i>& triangles) {
  if (!box_around(vertices).contains(point)) return false;
  const auto corner = [&](int vertex) -> Eigen::Vector3d {
    return vertices[static_cast<std::size_t>(vertex)] - point;
  };
  double angle = 0;
  for (const Eigen::Vector3i& triangle : triangles)
    angle += solid_angle(corner(triangle[0]), corner(triangle[1]), corner(triangle[2]));
  return std::abs(angle) > 2 * std::numbers::pi;
}

}  // namespace pliant
