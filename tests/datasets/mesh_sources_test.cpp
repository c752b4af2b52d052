#include "experiments/datasets/mesh_sources.h"

#include <gmock/gmock.h>

#include <cmath>

#include "experiments/datasets/mesh_stream.h"
#include "experiments/datasets/rendered_mesh.h"
#include "framework/core/angle.h"
#include "tests/datasets/data_of.h"
#include "tests/io/glb_file.h"
#include "tests/io/rigged_glb.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::config_error_of;
using test::count_points;
using test::data_error_of;
using test::data_of;
using test::load;
using test::LoadedPair;
using test::shared_device;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The square of 200 mm of square_glb() and the strip of rigged_glb().
class MeshSources : public test::TestFiles {
 protected:
  MeshSources() {
    write("square.glb", test::square_glb().bytes());
    write("strip.glb", test::RiggedGlb().bytes());
  }

  std::string section(const std::string& rest, const std::string& name = "square.glb") const {
    return "{type: gltf, mesh: " + file(name) +
           ", image_width: 160, image_height: 120, focal_length: 131.25" + rest + "}";
  }

  std::vector<Frame> frames_of(const std::string& rest, const std::string& name = "square.glb") const {
    const auto stream = data_of(section(rest, name))->open(shared_device(), 1);
    CheckedStream checked(*stream);
    std::vector<Frame> frames;
    while (auto frame = checked.next()) frames.push_back(std::move(*frame));
    return frames;
  }

  std::string error_of(const std::string& rest) const {
    return data_error_of([&] { frames_of(rest); });
  }
};

/// The middle of the pixels with depth.
Eigen::Vector2d middle_of(const DepthImage& depth) {
  Eigen::Vector2d sum(0, 0);
  int count = 0;
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      if (depth(u, v) > 0) {
        sum += Eigen::Vector2d(u, v);
        ++count;
      }
  return sum / count;
}

// What rendered_mesh renders on the host is the same picture.
TEST_F(MeshSources, SeeWhatTheHostRenders) {
  const std::string rest =
      ", source: [slide=0.25], target: [bulge=2], distance: 700, motion: {rotation_x: 12, shift_z: 30}";
  const LoadedPair pair = load(*data_of(section(rest)), 1);
  std::string as_rendered = section(rest);
  as_rendered.replace(as_rendered.find("gltf"), 4, "rendered_mesh");
  const LoadedPair expected = load(*data_of(as_rendered), 1);
  EXPECT_EQ(pair.name, expected.name);
  int others = 0;
  for (std::size_t i = 0; i < pair.source.depth.size(); ++i) {
    if (std::abs(pair.source.depth.pixels()[i] - expected.source.depth.pixels()[i]) > 1e-3) ++others;
    if (std::abs(pair.target.depth.pixels()[i] - expected.target.depth.pixels()[i]) > 1e-3) ++others;
    const Eigen::Vector3f& flow = pair.truth->scene_flow.pixels()[i];
    const Eigen::Vector3f& expected_flow = expected.truth->scene_flow.pixels()[i];
    if (!flow.allFinite() || !expected_flow.allFinite()) continue;
    EXPECT_LT((flow - expected_flow).norm(), 1e-2);
  }
  EXPECT_LT(others, 10) << "rays through edges";
  EXPECT_GT(count_points(pair.source.depth), 1300);
}

TEST_F(MeshSources, FillFourFifthsOfTheImageByDefault) {
  const auto frames = frames_of(", mesh_scale: 3000");
  EXPECT_NEAR(std::sqrt(count_points(frames[0].depth)), 0.8 * 120, 1.5);
  EXPECT_EQ(frames_of("")[0].depth(80, 60), 400) << "no nearer than depth cameras see";
}

TEST_F(MeshSources, ColoursMoveWithTheMaterial) {
  const auto frames = frames_of(", distance: 656.25, target: [slide=1]");
  // 20 mm there are 4 pixels.
  int equal = 0;
  for (int v = 50; v < 70; ++v)
    for (int u = 70; u < 90; ++u) {
      const Rgb before = frames[0].color(u, v);
      const Rgb after = frames[1].color(u + 4, v);
      equal += std::abs(before.g - after.g) < 12 && std::abs(before.r - after.r) < 12 ? 1 : 0;
    }
  EXPECT_GT(equal, 380);
  EXPECT_EQ(frames[0].color(2, 2), Rgb{});
  const auto other = frames_of(", distance: 656.25, texture_seed: 2");
  EXPECT_NE(frames[0].color.pixels(), other[0].color.pixels());
  EXPECT_EQ(frames[0].depth.pixels(), other[0].depth.pixels());
}

TEST_F(MeshSources, MoveSmoothlyFromSourceToTarget) {
  const auto pair = frames_of(", target: [slide=1]");
  const auto frames = frames_of(", target: [slide=1], frames: 5");
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_EQ(frames.front().depth.pixels(), pair.front().depth.pixels());
  EXPECT_EQ(frames.back().depth.pixels(), pair.back().depth.pixels());
  const double begin = middle_of(frames[0].depth).x();
  const double whole = middle_of(frames[4].depth).x() - begin;
  EXPECT_NEAR(middle_of(frames[1].depth).x() - begin, 0.15625 * whole, 0.6);
  EXPECT_NEAR(middle_of(frames[2].depth).x() - begin, 0.5 * whole, 0.6);
  EXPECT_DOUBLE_EQ(frames[3].time, 0.1);
}

TEST_F(MeshSources, PassTheirKeysInTime) {
  const std::string keys =
      ", keys: {start: {at: 0.5}, moved: {at: 0.7, pose: [slide=1]}, held: {at: 0.8, pose: [slide=1]}}";
  const auto stream = data_of(section(keys))->open(shared_device(), 1);
  EXPECT_EQ(stream->name(), "square, start to held");
  const auto frames = frames_of(keys);
  ASSERT_EQ(frames.size(), 10U);
  EXPECT_DOUBLE_EQ(frames.front().time, 0.5);
  EXPECT_DOUBLE_EQ(frames.back().time, 0.8);
  EXPECT_LT(middle_of(frames[3].depth).x(), middle_of(frames[6].depth).x());
  EXPECT_EQ(frames[6].depth.pixels(), frames[9].depth.pixels()) << "held";
  EXPECT_FALSE(stream->truth(1));
  EXPECT_FALSE(stream->truth(11));
  EXPECT_TRUE(stream->truth(10));
}

// A camera that moves to the right and looks at the middle sees the mesh in the middle of its image.
TEST_F(MeshSources, AreSeenByACameraThatMoves) {
  const auto frames = frames_of(
      ", distance: 700, keys: {a: {at: 0}, b: {at: 0.1, camera: {look_from: [300, 0, 0]}}, "
      "c: {at: 0.2, camera: {shift: [70, 0, 0]}}, d: {at: 0.3, camera: {rotation: [0, 5, 0]}}}");
  ASSERT_EQ(frames.size(), 10U);
  const double nearer_side = 700.0 * 700 / std::hypot(300, 700);
  EXPECT_NEAR(middle_of(frames[3].depth).x(), 79.5, 1.5) << "the nearer half is larger";
  EXPECT_LT(*std::min_element(frames[3].depth.pixels().begin(), frames[3].depth.pixels().end(),
                              [](float a, float b) { return (a > 0 ? a : 1e9F) < (b > 0 ? b : 1e9F); }),
            nearer_side + 100);
  EXPECT_NEAR(middle_of(frames[6].depth).x(), 79.5 - 131.25 * 70 / 700, 0.6);
  EXPECT_NEAR(middle_of(frames[9].depth).x(), 79.5 - 131.25 * std::tan(5 * degree), 0.8);
}

TEST_F(MeshSources, HaveAColourCameraOfTheirOwnWhereAsked) {
  const std::string camera =
      ", distance: 700, color_camera: {image_width: 80, image_height: 60, focal_length: 65, shift: [70, 0, "
      "0]}";
  const auto stream = data_of(section(camera))->open(shared_device(), 1);
  ASSERT_TRUE(stream->rig().color);
  EXPECT_NEAR(stream->rig().color_from_depth.translation().x(), -70, 1e-9);
  const auto frames = frames_of(camera);
  EXPECT_EQ(frames[0].color.width(), 80);
  // The square of 200 mm is 70 mm further left there.
  const int left = static_cast<int>(39.5 + 65 * -165 / 700.0);
  const int right = static_cast<int>(39.5 + 65 * 25 / 700.0);
  EXPECT_EQ(frames[0].color(left - 1, 30), Rgb{});
  EXPECT_NE(frames[0].color(left + 2, 30), Rgb{});
  EXPECT_NE(frames[0].color(right - 1, 30), Rgb{});
  EXPECT_EQ(frames[0].color(right + 2, 30), Rgb{});
}

TEST_F(MeshSources, SensorErrorsAreOfTheSeedAndLeaveTheTruthAlone) {
  const std::string noisy = ", target: [bulge=2], sensor: {axial: 1, quantisation: 1, lateral: 1}";
  const LoadedPair exact = load(*data_of(section(", target: [bulge=2]")), 1);
  const LoadedPair one = load(*data_of(section(noisy)), 1);
  const LoadedPair same = load(*data_of(section(noisy)), 1);
  const LoadedPair other = load(*data_of(section(noisy)), 2);
  EXPECT_EQ(one.source.depth.pixels(), same.source.depth.pixels());
  EXPECT_NE(one.source.depth.pixels(), other.source.depth.pixels());
  EXPECT_NE(one.source.depth.pixels(), exact.source.depth.pixels());
  EXPECT_EQ(one.source.color.pixels(), exact.source.color.pixels());
  for (std::size_t i = 0; i < exact.truth->scene_flow.size(); ++i) {
    const Eigen::Vector3f& flow = exact.truth->scene_flow.pixels()[i];
    if (!flow.allFinite()) continue;
    EXPECT_EQ(one.truth->scene_flow.pixels()[i], flow) << i;
  }
  EXPECT_EQ(one.truth->visible.pixels(), exact.truth->visible.pixels());
}

TEST_F(MeshSources, PlayAnimationsOfTheirFile) {
  const std::string wave = ", animation: wave, distance: 900";
  // The bone turns from 1 s to 3 s.
  const auto still = frames_of(wave + ", animation_end: 1", "strip.glb");
  EXPECT_EQ(still[0].depth.pixels(), still[1].depth.pixels());
  const auto moving = frames_of(wave + ", animation_begin: 1, animation_end: 3", "strip.glb");
  EXPECT_NE(moving[0].depth.pixels(), moving[1].depth.pixels());
  const auto half = frames_of(wave + ", animation_begin: 1, animation_end: 3, frames: 3", "strip.glb");
  EXPECT_EQ(half[2].depth.pixels(), moving[1].depth.pixels());
  EXPECT_THAT(config_error_of(section(", animation: wawe", "strip.glb")),
              AllOf(HasSubstr("'animation' is 'wawe'"), HasSubstr("did you mean 'wave'?")));
}

TEST_F(MeshSources, AllocateNothingAfterTheThirdFrame) {
  Device device;
  const auto stream =
      data_of(section(", target: [bulge=2], frames: 8, sensor: {axial: 1, shadow: 75}"))->open(device, 1);
  std::uint64_t after_third = 0;
  for (int i = 1; i <= 8; ++i) {
    ASSERT_TRUE(stream->next());
    ASSERT_EQ(stream->truth(i).has_value(), i > 1);
    if (i == 3) after_third = device.counts().allocations;
  }
  EXPECT_EQ(device.counts().allocations, after_third);
}

TEST_F(MeshSources, WhatCannotBeSeenIsAnError) {
  EXPECT_THAT(error_of(", motion: {shift_x: 5000}"),
              AllOf(HasSubstr("square.glb: no pixel of the camera sees the mesh in frame 2"),
                    HasSubstr("200 x 200 x 0 mm")));
  const std::string inside = data_error_of([&] {
    const auto stream =
        data_of("{type: head, distance: 5, image_width: 32, image_height: 24}")->open(shared_device(), 1);
    stream->next();
  });
  EXPECT_THAT(inside, HasSubstr("head: the camera is inside the mesh in frame 1; it is"));
}

TEST_F(MeshSources, WhatCannotBeAskedForIsAnError) {
  EXPECT_THAT(config_error_of(section(", target: [buldge=1]")),
              AllOf(HasSubstr("'target' of " + file("square.glb") + " names 'buldge'"),
                    HasSubstr("did you mean 'bulge'?")));
  EXPECT_THAT(config_error_of("{type: head, source: [smlie=1]}"), HasSubstr("did you mean 'smile'?"));
  EXPECT_THAT(config_error_of("{type: hand, texture: face}"),
              AllOf(HasSubstr("'texture' of hand"), HasSubstr("only a head has")));
  EXPECT_THAT(config_error_of(section(", keys: {a: {at: 0, pose: [x=1]}, b: {at: 1}}")),
              HasSubstr("'pose' of " + file("square.glb") + " names 'x'"));
  EXPECT_THAT(config_error_of(section(", keys: {}")),
              HasSubstr("'data.keys' has 0 entries; expected at least 2"));
  EXPECT_THAT(config_error_of(section(", keys: {a: {at: 1}, b: {at: 1}}")),
              HasSubstr("key 'b' of " + file("square.glb") + " is at 1 s; expected later than 1 s"));
  EXPECT_THAT(config_error_of(section(", keys: {a: {at: 0}, b: {at: 0.01}}")),
              HasSubstr("expected 2 to 1000000 frames"));
  EXPECT_THAT(config_error_of(section(", target: [bulge=1], keys: {a: {at: 0}, b: {at: 1}}")),
              HasSubstr("has both 'keys' and a 'source' or 'target'"));
  EXPECT_THAT(config_error_of(section(
                  ", keys: {a: {at: 0}, b: {at: 1, camera: {look_from: [0, 1, 0], shift: [0, 0, 1]}}}")),
              HasSubstr("'camera' both looks and is shifted"));
  EXPECT_THAT(config_error_of(section(
                  ", keys: {a: {at: 0}, b: {at: 1, camera: {look_from: [0, 0, 5], look_at: [0, 9, 5]}}}")),
              HasSubstr("'camera' looks straight up or down"));
  EXPECT_THAT(config_error_of(section(", keys: {a: {at: 0}, b: {at: 1, camera: {look_at: [0, 0, 0]}}}")),
              HasSubstr("'camera' looks at where it stands"));
}

TEST_F(MeshSources, AMeshInAnotherUnitIsToldWithItsSize) {
  const auto stream = data_of(section(", mesh_scale: 1"))->open(shared_device(), 1);
  EXPECT_THAT(stream->warnings(),
              ElementsAre(AllOf(HasSubstr("it is 0.2 x 0.2 x 0 mm"), HasSubstr("mesh_scale"))));
  EXPECT_THAT(data_of(section(""))->open(shared_device(), 1)->warnings(), IsEmpty());
}

}  // namespace
}  // namespace pliant
