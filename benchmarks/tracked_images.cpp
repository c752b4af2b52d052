#include "benchmarks/tracked_images.h"

#include <cmath>
#include <numbers>

#include "experiments/datasets/datasets.h"
#include "experiments/datasets/mesh_stream.h"
#include "framework/config/config.h"
#include "framework/imaging/depth_map.h"

namespace pliant::bench {
namespace {

constexpr std::uint64_t seed = 1;
const DepthSensorSettings kinect{1, 1, 1, 80, 75};

/// `open`: it is seen from inside, and has no side towards the camera.
void add_box(Mesh& mesh, const Eigen::Vector3f& centre, const Eigen::Vector3f& half, bool open) {
  const int first = static_cast<int>(mesh.vertices.size());
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int axis) { return (corner >> axis & 1) != 0 ? 1.0F : -1.0F; };
    const Eigen::Vector3f sides(side(0), side(1), side(2));
    mesh.vertices.emplace_back(centre + half.cwiseProduct(sides));
  }
  std::vector<Eigen::Vector4i> sides{{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}};
  if (!open) sides.emplace_back(4, 5, 7, 6);
  for (const Eigen::Vector4i& side : sides) {
    Eigen::Vector4i corners = side.array() + first;
    if (open) corners.reverseInPlace();
    mesh.triangles.emplace_back(corners[0], corners[1], corners[2]);
    mesh.triangles.emplace_back(corners[0], corners[2], corners[3]);
  }
}

void add_ball(Mesh& mesh, const Eigen::Vector3f& centre, float radius) {
  constexpr int rings = 32, around = 2 * rings;
  const int first = static_cast<int>(mesh.vertices.size());
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const double turn = std::numbers::pi * j / rings, angle = std::numbers::pi * i / rings;
      const Eigen::Vector3d direction(std::sin(turn) * std::cos(angle), std::cos(turn),
                                      -std::sin(turn) * std::sin(angle));
      mesh.vertices.emplace_back(centre + radius * direction.cast<float>());
    }
  }
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = first + j * around + i, b = first + j * around + (i + 1) % around;
      mesh.triangles.emplace_back(a, a + around, b);
      mesh.triangles.emplace_back(b, a + around, b + around);
    }
  }
}

/// y up; the camera looks along -z.
Mesh make_room() {
  Mesh room;
  add_box(room, {0, 0, 0}, {1400, 1000, 1450}, true);
  add_box(room, {-550, -480, -500}, {450, 30, 350}, false);  // a table
  add_box(room, {-550, -750, -500}, {60, 250, 60}, false);
  add_box(room, {850, -500, -1000}, {350, 500, 300}, false);  // a chest
  add_box(room, {300, 450, -1350}, {400, 300, 80}, false);    // a board on the wall
  add_ball(room, {-650, -280, -500}, 170);
  add_ball(room, {150, -750, -300}, 250);
  add_ball(room, {850, 180, -1000}, 180);
  return room;
}

TrackedImages images_of(const FrameSource& source, Device& device) {
  const auto stream = source.open(device, seed);
  TrackedImages images{stream->rig(), *stream->next(), *stream->next(), {}, {}, 0};
  images.after_from_before = stream->camera_pose(2)->inverse() * *stream->camera_pose(1);
  images.region = whole_image(images.rig.depth);
  return images;
}

}  // namespace

TrackedImages room_images(Device& device) {
  const Mesh mesh = make_room();
  SceneKey after{1 / frame_rate, rest_of(mesh), {}, {}};
  after.camera.position = {12, -6, 10};
  after.camera.orientation = turned({0.4, -0.6, 0.2});
  MeshScene scene{"room",
                  "room",
                  mesh,
                  rest_of(mesh),
                  box_around(mesh, rest_of(mesh)),
                  std::nullopt,
                  1500,
                  Rig{{525, 525, 319.5, 239.5, 640, 480}},
                  {SceneKey{0, rest_of(mesh), {}, {}}, after},
                  2,
                  SurfaceColor(SurfaceColor::Kind::rich, seed),
                  kinect,
                  {}};
  return images_of(MeshSource(std::move(scene)), device);
}

TrackedImages head_images(Device& device) {
  Registry registry;
  register_datasets(registry);
  const ConfigText text{
      "data: {type: head, distance: 700,"
      " sensor: {axial: 1, quantisation: 1, lateral: 1, grazing: 80, shadow: 75},"
      " keys: {before: {at: 0}, after: {at: 0.034, camera: {shift: [6, -3, 4], rotation: [0.3, -0.5, "
      "0.2]}}}}",
      "head",
      {}};
  const Experiment experiment =
      load_experiment({text, {}, {}}, {component("data", FrameSource::kind)}, registry);
  const auto head = registry.make<FrameSource>(experiment.values.section("data"));
  TrackedImages images = images_of(*head, device);
  images.depth_cut = 1300;
  images.region = DepthMap(images.before).window;
  return images;
}

}  // namespace pliant::bench
