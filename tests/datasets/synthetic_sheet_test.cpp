#include "experiments/datasets/synthetic_sheet.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "framework/core/error.h"
#include "tests/datasets/data_of.h"

namespace pliant {
namespace {

using test::config_error_of;
using test::data_of;
using test::load;
using test::LoadedPair;
using test::shared_device;
using ::testing::HasSubstr;

using Check = std::function<void(int u, int v, const Eigen::Vector3d& point, const Eigen::Vector3d& motion)>;

/// Calls `check` for every source pixel with depth; gives their number.
int for_each_point(const LoadedPair& pair, const Check& check) {
  int count = 0;
  for (int v = 0; v < pair.camera.height; ++v) {
    for (int u = 0; u < pair.camera.width; ++u) {
      if (pair.source.depth(u, v) <= 0) continue;
      ++count;
      check(u, v, pair.camera.unproject(u, v, pair.source.depth(u, v)),
            Eigen::Vector3d(pair.motion(u, v).cast<double>()));
    }
  }
  return count;
}

TEST(BendingSheet, LengthsAreKept) {
  const BendingSheet sheet({});
  double length = 0;
  Eigen::Vector3d last = sheet.bent(-150, 20);
  constexpr double kStep = 0.01;
  for (int i = 1; i <= 30000; ++i) {
    const Eigen::Vector3d next = sheet.bent(-150 + i * kStep, 20);
    length += (next - last).norm();
    last = next;
  }
  EXPECT_NEAR(length, 300, 1e-3);
  EXPECT_NEAR((sheet.bent(30, -50) - sheet.bent(30, 70)).norm(), 120, 1e-9);
  // Directions along and across stay at right angles, so that areas are kept too.
  const Eigen::Vector3d along = sheet.bent(31, 10) - sheet.bent(29, 10);
  EXPECT_NEAR(along.dot(sheet.bent(30, 11) - sheet.bent(30, 9)), 0, 1e-9);
}

TEST(BendingSheet, WhatIsSeenAlongARayLiesOnIt) {
  const BendingSheet sheet({});
  int seen = 0;
  for (double a = -0.25; a <= 0.25; a += 0.0137) {
    for (double b = -0.2; b <= 0.2; b += 0.0173) {
      const auto material = sheet.see_bent(a, b);
      if (!material) continue;
      ++seen;
      const Eigen::Vector3d point = sheet.bent(material->x(), material->y());
      EXPECT_NEAR(point.x(), a * point.z(), 1e-6);
      EXPECT_NEAR(point.y(), b * point.z(), 1e-6);
    }
  }
  EXPECT_GT(seen, 300);
  EXPECT_FALSE(sheet.see_flat(0.3, 0));
  EXPECT_FALSE(sheet.see_bent(0.3, 0));
}

TEST(BendingSheet, ShapesThatCannotBeSeenWholeAreErrors) {
  EXPECT_THAT(config_error_of("{type: synthetic_sheet, amplitude: 790}"), HasSubstr("reaches the camera"));
  EXPECT_THAT(config_error_of("{type: synthetic_sheet, frequency: 5}"), HasSubstr("hides a part of itself"));
}

TEST(SyntheticSheet, TheTrueMotionLeadsOntoTheBentSurface) {
  const LoadedPair pair = load(*data_of("synthetic_sheet"), 1);
  const BendingSheet sheet({});
  const int points = for_each_point(pair, [&](int, int, const Eigen::Vector3d& point,
                                              const Eigen::Vector3d& motion) {
    const Eigen::Vector3d moved = point + motion;
    const auto material = sheet.see_bent(moved.x() / moved.z(), moved.y() / moved.z());
    if (!material) {  // only rounding takes the rim off the sheet
      EXPECT_TRUE(std::abs(std::abs(point.x()) - 160) < 1e-3 || std::abs(std::abs(point.y()) - 120) < 1e-3);
      return;
    }
    EXPECT_LT((sheet.bent(material->x(), material->y()) - moved).norm(), 1e-3);
    EXPECT_LT((Eigen::Vector2d(point.x(), point.y()) - *material).norm(), 1e-3) << "another material";
  });
  EXPECT_GT(points, 30000);
}

TEST(SyntheticSheet, DeformsByTwentyMillimetresAndNotAlongTheRaysOnly) {
  const LoadedPair pair = load(*data_of("synthetic_sheet"), 1);
  double longest = 0;
  double sideways = 0;
  for_each_point(pair, [&](int, int, const Eigen::Vector3d& point, const Eigen::Vector3d& motion) {
    const Eigen::Vector3d ray = point.normalized();
    longest = std::max(longest, motion.norm());
    sideways = std::max(sideways, (motion - motion.dot(ray) * ray).norm());
  });
  EXPECT_GE(longest, 20);
  EXPECT_GE(sideways, 3.5);
}

TEST(SyntheticSheet, ColoursMoveWithTheMaterial) {
  const LoadedPair pair = load(*data_of("{type: synthetic_sheet, amplitude: 60, approach: 60}"), 1);
  double moved_difference = 0;
  double still_difference = 0;
  int count = 0;
  for_each_point(pair, [&](int u, int v, const Eigen::Vector3d& point, const Eigen::Vector3d& motion) {
    const Eigen::Vector2d pixel = pair.camera.project(point + motion).array().round();
    const int x = static_cast<int>(pixel.x());
    const int y = static_cast<int>(pixel.y());
    if (!pair.target.depth.contains(x, y) || pair.target.depth(x, y) <= 0) return;
    ++count;
    moved_difference += std::abs(pair.source.color(u, v).g - pair.target.color(x, y).g);
    still_difference += std::abs(pair.source.color(u, v).g - pair.target.color(u, v).g);
  });
  EXPECT_LT(moved_difference / count, 6);
  EXPECT_GT(still_difference / count, 2 * moved_difference / count);
}

TEST(SyntheticSheet, NoiseComesFromTheSeedAndLeavesTheTruthAlone) {
  const LoadedPair clean = load(*data_of("synthetic_sheet"), 1);
  const auto noisy = data_of("{type: synthetic_sheet, noise: 1}");
  const LoadedPair first = load(*noisy, 1);
  EXPECT_EQ(first.source.depth.pixels(), load(*noisy, 1).source.depth.pixels());
  EXPECT_NE(first.source.depth.pixels(), load(*noisy, 2).source.depth.pixels());
  EXPECT_NE(first.source.depth.pixels(), clean.source.depth.pixels());
  EXPECT_NE(first.target.depth.pixels(), clean.target.depth.pixels());
  for_each_point(clean, [&](int u, int v, const Eigen::Vector3d&, const Eigen::Vector3d& motion) {
    EXPECT_EQ(first.motion(u, v).cast<double>(), motion);
  });
}

TEST(SyntheticSheet, ACameraThatSeesNothingIsAnError) {
  EXPECT_THROW(load(*data_of("{type: synthetic_sheet, cx: 9000}"), 1), DataError);
}

/// The frames of a stream, read to its end.
std::vector<Frame> frames_of(FrameStream& stream) {
  CheckedStream checked(stream);
  std::vector<Frame> frames;
  while (auto frame = checked.next()) frames.push_back(std::move(*frame));
  return frames;
}

const std::string small = "image_width: 64, image_height: 48, focal_length: 52.5";

TEST(SyntheticSheetStream, OfTwoFramesIsThePair) {
  const auto source = data_of("{type: synthetic_sheet, noise: 1, " + small + "}");
  const auto frames = frames_of(*source->open(shared_device(), 3));
  const LoadedPair pair = load(*source, 3);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].depth.pixels(), pair.source.depth.pixels());
  EXPECT_EQ(frames[1].depth.pixels(), pair.target.depth.pixels());
}

TEST(SyntheticSheetStream, BendsFromFlatToTheWhole) {
  const auto short_one =
      frames_of(*data_of("{type: synthetic_sheet, " + small + "}")->open(shared_device(), 1));
  const auto frames =
      frames_of(*data_of("{type: synthetic_sheet, frames: 7, " + small + "}")->open(shared_device(), 1));
  ASSERT_EQ(frames.size(), 7U);
  EXPECT_EQ(frames.front().depth.pixels(), short_one.front().depth.pixels());
  EXPECT_EQ(frames.back().depth.pixels(), short_one.back().depth.pixels());
  EXPECT_EQ(frames.back().color.pixels(), short_one.back().color.pixels());
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_DOUBLE_EQ(frames[i].time, static_cast<double>(i) / 30);
  // The middle bulges away from the camera and the whole comes nearer: 18 mm less 25 mm.
  EXPECT_NEAR(frames[3].depth(32, 24), 803.5, 0.1) << "half-way";
  for (std::size_t i = 1; i < frames.size(); ++i)
    EXPECT_GT(frames[i].depth(32, 24), frames[i - 1].depth(32, 24)) << i;
}

TEST(SyntheticSheetStream, KnowsTheMotionFromTheFirstFrameToEach) {
  const auto stream = data_of("{type: synthetic_sheet, frames: 4, " + small + "}")->open(shared_device(), 1);
  const PairTruth half = stream->truth(3).value();
  const PairTruth whole = stream->truth(4).value();
  const auto frames = frames_of(*stream);
  const Eigen::Vector3f motion = half.scene_flow(32, 24);
  EXPECT_NEAR(frames[0].depth(32, 24) + motion.z(), frames[2].depth(32, 24), 0.05);
  EXPECT_GT(whole.scene_flow(32, 24).z(), motion.z());
  EXPECT_FALSE(stream->truth(1));
  EXPECT_FALSE(stream->truth(5));
}

// A million frames at once would not fit into any memory.
TEST(SyntheticSheetStream, MakesFramesWhenTheyAreAskedFor) {
  const auto stream =
      data_of("{type: synthetic_sheet, frames: 1000000, " + small + "}")->open(shared_device(), 1);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(stream->next());
}

}  // namespace
}  // namespace pliant
