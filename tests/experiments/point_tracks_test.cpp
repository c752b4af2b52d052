// Where points that are followed went, as files that others read.
#include "experiments/tasks/point_tracks.h"

#include <gmock/gmock.h>

#include "framework/io/gltf.h"
#include "framework/io/surface_mesh.h"
#include "tests/io/test_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using Points = std::vector<Eigen::Vector3f>;

/// A grid of points that bulge more from frame to frame.
class PointTracksTest : public TestFiles {
 protected:
  static constexpr int step = 3;
  static constexpr int columns = 5;
  static constexpr int rows = 4;
  static constexpr double start = 1.3e9;  // s: what cameras tell is no small number

  PointTracksTest() {
    for (int v = 0; v < rows; ++v)
      for (int u = 0; u < columns; ++u) pixels_.emplace_back(60 + step * u, 30 + step * v);
  }

  Points points_at(int number) const {
    Points points;
    for (const Eigen::Vector2i& pixel : pixels_) {
      const auto u = static_cast<float>(pixel.x());
      const auto v = static_cast<float>(pixel.y());
      points.emplace_back(4 * u, 4 * v, 500 + 0.1F * u + 0.25F * static_cast<float>(number) * (v - 30));
    }
    return points;
  }

  static double time_of(int number) { return start + number / 30.0; }

  std::vector<fs::path> record(PointTracks::Options options, int first, int last) {
    options.step = step;
    PointTracks tracks(file(""), options);
    for (int number = first; number <= last; ++number)
      tracks.add(number, time_of(number), pixels_, points_at(number));
    return tracks.finish();
  }

  std::vector<Eigen::Vector2i> pixels_;
};

/// glTF's frame.
Eigen::Vector3d upright(const Eigen::Vector3f& point) { return {point.x(), -point.y(), -point.z()}; }

TEST_F(PointTracksTest, TheAnimationIsAtThePointsAtEachKey) {
  const auto files = record({true, false}, 7, 16);
  ASSERT_EQ(files, std::vector<fs::path>{file("tracks.glb")});
  const GltfScene scene = read_gltf_scene(file("tracks.glb"));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.mesh.triangles.size(), 2U * (columns - 1) * (rows - 1));
  ASSERT_EQ(scene.mesh.targets.size(), 9U) << "frame 7 is the mesh at rest";
  EXPECT_EQ(scene.mesh.targets[0].name, "frame_0008");
  ASSERT_EQ(scene.animations.size(), 1U);
  const Animation& animation = scene.animations[0];
  EXPECT_NEAR(animation.duration, 0.3, 1e-6);
  for (int number = 7; number <= 16; ++number) {
    const auto moved = scene.mesh.deform(animation.pose(scene.mesh, time_of(number) - time_of(7)));
    const Points points = points_at(number);
    ASSERT_EQ(moved.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_LT((moved[i] - upright(points[i])).norm(), 2e-3) << "frame " << number << ", point " << i;
  }
  const auto between = scene.mesh.deform(animation.pose(scene.mesh, 0.5 / 30));
  const Points before = points_at(7);
  const Points after = points_at(8);
  EXPECT_LT((between.back() - upright((before.back() + after.back()) / 2)).norm(), 2e-3);
}

TEST_F(PointTracksTest, OfManyFramesTheAnimationHasEvenlySpacedOnes) {
  record({true, false}, 1, 150);
  const GltfScene scene = read_gltf_scene(file("tracks.glb"));
  ASSERT_EQ(scene.animations.size(), 1U);
  const std::vector<double>& times = scene.animations[0].weights.at(0).weights.times;
  ASSERT_EQ(times.size(), 38U);
  ASSERT_LE(times.size(), PointTracks::most_keys);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], 4 * static_cast<double>(i) / 30, 1e-5);
  EXPECT_EQ(scene.mesh.targets.back().name, "frame_0149");
}

TEST_F(PointTracksTest, AMeshAFrameKeepsTheOrderOfItsVertices) {
  const auto files = record({false, true, 3}, 5, 12);
  ASSERT_EQ(files.size(), 3U) << "5, 8 and 11";
  EXPECT_EQ(files.back(), fs::path(file("tracks/frame_0011.ply")));
  for (const int number : {5, 8, 11}) {
    const SurfaceMesh mesh = read_surface_mesh(files[static_cast<std::size_t>(number - 5) / 3].string(), 1);
    EXPECT_EQ(mesh.vertices, points_at(number));
    EXPECT_EQ(mesh.triangles.size(), 2U * (columns - 1) * (rows - 1));
  }
  EXPECT_FALSE(fs::exists(file("tracks.glb")));
}

TEST_F(PointTracksTest, TrianglesFaceTheCameraAndSpanNeitherGapsNorJumps) {
  pixels_.erase(pixels_.begin() + columns + 1);  // of the second row the second
  Points points = points_at(0);
  points.back().z() += 100;
  PointTracks tracks(file(""), {false, true, 1, step, 0.05});
  tracks.add(1, 0, pixels_, points);
  const SurfaceMesh mesh = read_surface_mesh(tracks.finish().at(0).string(), 1);
  EXPECT_EQ(mesh.triangles.size(), 2U * (columns - 1) * (rows - 1) - 6 - 1);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const auto corner = [&](int i) { return mesh.vertices[static_cast<std::size_t>(triangle[i])]; };
    EXPECT_LT((corner(1) - corner(0)).cross(corner(2) - corner(0)).z(), 0);
  }
}

TEST_F(PointTracksTest, OneFrameIsAMeshThatStandsAndNoneIsNoFile) {
  record({true, false}, 4, 4);
  const GltfScene scene = read_gltf_scene(file("tracks.glb"));
  EXPECT_TRUE(scene.animations.empty());
  EXPECT_EQ(scene.mesh.vertices.size(), pixels_.size());
  EXPECT_TRUE(record({true, true}, 2, 1).empty());
}

}  // namespace
}  // namespace pliant::test
