// Truth of meshes that move and deform before a camera: where points of any frame are in any other.
#include <gtest/gtest.h>

#include <algorithm>

#include "experiments/datasets/mesh_stream.h"
#include "tests/datasets/data_of.h"
#include "tests/io/glb_file.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using test::data_of;
using test::shared_device;

class FollowedPoints : public test::TestFiles {
 protected:
  FollowedPoints() { write("square.glb", test::square_glb().bytes()); }

  /// A stream of the square of 200 mm, 700 mm away, with some keys.
  std::unique_ptr<DataStream> stream_of(const std::string& keys) const {
    return data_of("{type: gltf, mesh: " + file("square.glb") +
                   ", image_width: 96, image_height: 72, focal_length: 79, distance: 700, keys: " + keys +
                   "}")
        ->open(shared_device(), 1);
  }
};

const MeshStream& mesh_stream(const DataStream& stream) { return dynamic_cast<const MeshStream&>(stream); }

std::vector<Eigen::Vector2i> pixels_of(const Camera& camera) {
  std::vector<Eigen::Vector2i> pixels;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) pixels.emplace_back(u, v);
  return pixels;
}

bool has_depth(const Frame& frame) {
  const auto& pixels = frame.depth.pixels();
  return std::any_of(pixels.begin(), pixels.end(), [](float depth) { return depth > 0; });
}

// Whether the mesh moves, or the camera, or both: seen from the frame that goes with it, it stays.
TEST_F(FollowedPoints, TheFrameOfReferenceGoesWithAMeshThatMoves) {
  const auto stream = stream_of(
      "{a: {at: 0, motion: {rotation_x: -5, shift_x: 20}, camera: {shift: [5, 6, 7]}}, "
      "b: {at: 0.1, motion: {rotation_y: 20, rotation_x: 8, shift_x: -30, shift_z: 40}}, "
      "c: {at: 0.2, motion: {rotation_y: -10}, camera: {look_from: [90, -40, 30]}}}");
  const Mesh began = *stream->surface(1);
  for (const int number : {2, 4, 5, 7}) {
    const Eigen::Isometry3d motion = stream->camera_pose(number)->inverse() * *stream->camera_pose(1);
    const Mesh moved = *stream->surface(number);
    for (std::size_t i = 0; i < began.vertices.size(); ++i)
      EXPECT_LT((motion * began.vertices[i].cast<double>() - moved.vertices[i].cast<double>()).norm(), 1e-3)
          << number;
  }
}

TEST_F(FollowedPoints, ThatOfAMeshThatStaysIsTheScenes) {
  const auto stream = stream_of("{a: {at: 0}, b: {at: 0.1, camera: {shift: [30, 0, -10]}}}");
  EXPECT_EQ(stream->camera_pose(1)->matrix(), Eigen::Matrix4d::Identity());
  EXPECT_TRUE(stream->camera_pose(4)->translation().isApprox(Eigen::Vector3d(30, 0, -10), 1e-12));
}

TEST_F(FollowedPoints, AreWhereTheSceneFlowLeadsTo) {
  const auto stream = stream_of(
      "{a: {at: 0}, b: {at: 0.1, pose: [bulge=2, slide=0.5], motion: {rotation_y: 30, shift_x: 400}}}");
  const Camera& camera = stream->rig().depth;
  const auto pixels = pixels_of(camera);
  const DepthImage depth = mesh_stream(*stream).exact_depth(1);
  const PairTruth truth = *stream->truth(4);
  const TruePoints points = *stream->points_of(1, pixels, 4);
  int visible = 0;
  int hidden = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int u = pixels[i].x();
    const int v = pixels[i].y();
    ASSERT_EQ(points.positions[i].allFinite(), depth(u, v) > 0);
    EXPECT_EQ(points.visible[i], truth.visible(u, v) != 0) << u << ", " << v;
    if (!(depth(u, v) > 0)) continue;
    ++(points.visible[i] ? visible : hidden);
    const Eigen::Vector3f moved = camera.unproject(u, v, depth(u, v)).cast<float>() + truth.scene_flow(u, v);
    EXPECT_LT((points.positions[i] - moved).norm(), 0.01) << u << ", " << v;
  }
  EXPECT_GT(visible, 100);
  EXPECT_GT(hidden, 20) << "beside the image";
}

// Of the frame that began a model, which need not be the first.
TEST_F(FollowedPoints, MayBeOfAnyFrame) {
  const auto stream =
      stream_of("{a: {at: 0}, b: {at: 0.2, pose: [bulge=2], motion: {rotation_x: 20, shift_y: 20}}}");
  const Camera& camera = stream->rig().depth;
  const auto pixels = pixels_of(camera);
  const DepthImage depth = mesh_stream(*stream).exact_depth(3);
  const TruePoints there = *stream->points_of(3, pixels, 3);
  const TruePoints later = *stream->points_of(3, pixels, 7);
  const Mesh surface = *stream->surface(7);
  int count = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float z = depth(pixels[i].x(), pixels[i].y());
    if (!(z > 0)) continue;
    EXPECT_LT((there.positions[i] - camera.unproject(pixels[i].x(), pixels[i].y(), z).cast<float>()).norm(),
              0.01);
    EXPECT_GT((later.positions[i] - there.positions[i]).norm(), 1);
    ++count;
  }
  EXPECT_GT(count, 200);
}

TEST_F(FollowedPoints, WhatLeavesTheImageMayReturn) {
  const auto stream = stream_of(
      "{a: {at: 0}, b: {at: 0.1, motion: {shift_x: 900}}, c: {at: 0.2, motion: {shift_x: 900}}, d: {at: "
      "0.3}}");
  CheckedStream checked(*stream);
  std::vector<bool> sees;
  std::optional<Frame> last;
  while (auto frame = checked.next()) {
    sees.push_back(has_depth(*frame));
    last = std::move(frame);
  }
  ASSERT_EQ(sees.size(), 10U);
  EXPECT_TRUE(sees[0]);
  EXPECT_FALSE(sees[4]);
  EXPECT_TRUE(sees[9]);
  EXPECT_EQ(last->depth.pixels(), mesh_stream(*stream).exact_depth(1).pixels());
}

TEST_F(FollowedPoints, WhatIsNotThereInTheFirstFrameIsAnError) {
  const auto stream =
      stream_of("{a: {at: 0, motion: {shift_x: 900}}, b: {at: 0.1}, c: {at: 0.2, motion: {shift_x: 9}}}");
  const std::string message = data_error_of([&] { stream->next(); });
  EXPECT_NE(message.find("no pixel of the camera sees the mesh in frame 1"), std::string::npos) << message;
}

}  // namespace
}  // namespace pliant
