// Truth is true: what the first frame shows, moved by its scene flow, lies on the surface of the second.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/datasets/mesh_stream.h"
#include "experiments/modeller/figure.h"
#include "framework/config/config.h"
#include "tests/datasets/data_of.h"
#include "tests/io/glb_file.h"
#include "tests/io/rigged_glb.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_of;
using test::shared_device;

// A fifth of the usual image.
const std::string camera = "image_width: 128, image_height: 96, focal_length: 105";

/// The triangles of the target, which rays are cast on one by one.
class MeshSurface {
 public:
  explicit MeshSurface(const MeshScene& scene, int frame)
      : vertices_(scene.vertices_at(scene.time_of(frame))), triangles_(scene.mesh.triangles) {}

  /// From a point to the plane of the first triangle on the ray from the camera to it.
  double distance_to_first(const Eigen::Vector3d& point) const {
    constexpr double slack = 1e-4;  // the ray may go through an edge
    double first = std::numeric_limits<double>::infinity();
    double distance = first;
    for (const Eigen::Vector3i& triangle : triangles_) {
      const auto corner = [&](int i) { return vertices_[static_cast<std::size_t>(triangle[i])]; };
      const Eigen::Vector3d a = corner(0);
      const Eigen::Vector3d ab = corner(1) - a;
      const Eigen::Vector3d ac = corner(2) - a;
      const Eigen::Vector3d normal = ab.cross(ac);
      const double facing = normal.dot(point);
      const double way = normal.dot(a) / facing;  // of the way from the camera to the point
      if (!(way > 0 && way < first)) continue;
      const Eigen::Vector3d met = way * point - a;
      const double whole = normal.squaredNorm();
      const double b = met.cross(ac).dot(normal) / whole;
      const double c = ab.cross(met).dot(normal) / whole;
      if (b < -slack || c < -slack || b + c > 1 + slack) continue;
      first = way;
      distance = std::abs(normal.normalized().dot(point - a));
    }
    return distance;
  }

 private:
  std::vector<Eigen::Vector3d> vertices_;
  const std::vector<Eigen::Vector3i>& triangles_;
};

struct Counts {
  int visible = 0;
  int hidden = 0;
  int touching = 0;  ///< visible, though something lies before it so near that the z-buffer cannot tell
};

/// Checks that what is visible lies on what the target shows there within 0.1 mm, in every `step`-th pixel.
Counts check_truth(const MeshStream& stream, int step) {
  const int last = stream.scene().frames;
  const DepthImage depth = stream.exact_depth(1);
  const PairTruth truth = stream.truth(last).value();
  const Camera& from = stream.rig().depth;
  const MeshSurface target(stream.scene(), last);
  Counts counts;
  for (std::size_t i = 0; i < depth.size(); i += static_cast<std::size_t>(step)) {
    const int u = static_cast<int>(i) % depth.width();
    const int v = static_cast<int>(i) / depth.width();
    const Eigen::Vector3f& flow = truth.scene_flow(u, v);
    EXPECT_EQ(flow.allFinite(), depth(u, v) > 0) << u << ", " << v;
    if (!(depth(u, v) > 0)) continue;
    const Eigen::Vector3d moved = from.unproject(u, v, depth(u, v)) + flow.cast<double>();
    const Eigen::Vector2d shift = from.project(moved) - Eigen::Vector2d(u, v);
    EXPECT_LT((shift - truth.optical_flow(u, v).cast<double>()).norm(), 0.01) << u << ", " << v;
    if (truth.visible(u, v) == 0) {
      ++counts.hidden;
      continue;
    }
    ++counts.visible;
    const double distance = target.distance_to_first(moved);
    EXPECT_LT(distance, nearest_hiding + hiding_pixels * moved.z() / from.fx) << u << ", " << v;
    if (distance > 0.1) ++counts.touching;
  }
  return counts;
}

Parameters identity_of(const FigureKind& kind) {
  const ConfigText nothing{"identity: {}\n", "nothing", ""};
  return load_experiment({nothing, {}, {}}, {group("identity", kind.identity)}, {})
      .values.section("identity");
}

Counts check_truth(const std::string& section, int step) {
  const auto stream = data_of(section)->open(shared_device(), 1);
  return check_truth(dynamic_cast<const MeshStream&>(*stream), step);
}

TEST(MeshTruth, IsTrueOfEveryFigureInEveryPose) {
  for (const FigureKind& kind : figure_kinds()) {
    const Figure figure = kind.make(identity_of(kind));
    const auto stream =
        data_of("{type: " + kind.name + ", motion: {rotation_y: 4, shift_x: 6, shift_z: -8}, " + camera + "}")
            ->open(shared_device(), 1);
    for (const NamedPose& pose : figure.poses) {
      SCOPED_TRACE(kind.name + " " + pose.name);
      MeshScene scene = dynamic_cast<const MeshStream&>(*stream).scene();
      scene.keys.back().pose = read_pose(figure, {pose.name + "=1"}, "test");
      const MeshStream posed(std::make_shared<const MeshScene>(std::move(scene)), shared_device(), 1);
      const Counts counts = check_truth(posed, 17);
      EXPECT_GT(counts.visible, 15);
      EXPECT_LE(50 * counts.touching, counts.visible) << "fingers of a fist touch";
    }
  }
}

class MeshTruthOfFiles : public test::TestFiles {};

TEST_F(MeshTruthOfFiles, IsTrueOfMorphTargets) {
  write("square.glb", test::square_glb().bytes());
  const Counts counts =
      check_truth("{type: gltf, mesh: " + file("square.glb") +
                      ", target: [bulge=3, slide=1], motion: {rotation_x: 20}, " + camera + "}",
                  1);
  EXPECT_GT(counts.visible, 1000);
  EXPECT_EQ(counts.touching, 0);
}

TEST_F(MeshTruthOfFiles, IsTrueOfASkin) {
  write("strip.glb", test::RiggedGlb().bytes());
  const Counts counts = check_truth(
      "{type: gltf, mesh: " + file("strip.glb") + ", target: [bone.x=25, bone.z=30], " + camera + "}", 1);
  EXPECT_GT(counts.visible, 100);
  EXPECT_EQ(counts.touching, 0);
}

// The camera turns and comes nearer while the mesh turns the other way.
TEST_F(MeshTruthOfFiles, IsTrueWhereTheCameraMoves) {
  write("square.glb", test::square_glb().bytes());
  const Counts counts = check_truth(
      "{type: gltf, mesh: " + file("square.glb") + ", " + camera +
          ", keys: {a: {at: 0}, b: {at: 1, pose: [bulge=2], motion: {rotation_y: -25}, "
          "camera: {look_from: [150, -60, 40]}}, c: {at: 1.5, camera: {look_from: [90, 80, 30]}}}}",
      1);
  EXPECT_GT(counts.visible, 1000);
  EXPECT_EQ(counts.touching, 0);
}

}  // namespace
}  // namespace pliant
