#include "experiments/datasets/tum_poses.h"

#include <gmock/gmock.h>

#include <fmt/format.h>

#include <numbers>

#include "tests/datasets/sequence_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TumPosesFile : public test::SequenceFiles {
 protected:
  TumPoses poses(const std::string& text) const { return TumPoses(write("groundtruth.txt", text)); }
  std::string error_with(const std::string& text) const {
    return test::data_error_of([&] { poses(text); });
  }
};

TEST_F(TumPosesFile, AreMillimetresAndTurnPointsOfTheCamera) {
  // A quarter turn about z: x of the camera is y of the world.
  const auto pose =
      poses("# timestamp tx ty tz qx qy qz qw\n1305.5 1 -2 0.25 0 0 0.70710678 0.70710678\n").at(1305.5);
  ASSERT_TRUE(pose);
  EXPECT_TRUE((*pose * Eigen::Vector3d(100, 0, 0)).isApprox(Eigen::Vector3d(1000, -1900, 250), 1e-6));
}

TEST_F(TumPosesFile, MoveAndTurnEvenlyInBetween) {
  const double eighth = std::numbers::pi / 8;
  const TumPoses path =
      poses(fmt::format("1 0 0 0 0 0 0 1\n1.08 0.4 0 0 0 {} 0 {}\n", std::sin(eighth), std::cos(eighth)));
  const auto pose = path.at(1.02);
  ASSERT_TRUE(pose);
  EXPECT_TRUE(pose->translation().isApprox(Eigen::Vector3d(100, 0, 0), 1e-9));
  const Eigen::AngleAxisd turn(pose->rotation());
  EXPECT_NEAR(turn.angle(), std::numbers::pi / 16, 1e-9);
  EXPECT_TRUE(turn.axis().isApprox(Eigen::Vector3d::UnitY(), 1e-6));
}

TEST_F(TumPosesFile, TellNothingBeforeAfterAndInGaps) {
  const TumPoses path = poses("1 0 0 0 0 0 0 1\n1.1 1 0 0 0 0 0 1\n1.3 2 0 0 0 0 0 1\n");
  EXPECT_FALSE(path.at(0.999));
  EXPECT_FALSE(path.at(1.301));
  EXPECT_FALSE(path.at(1.2)) << "200 ms lie between its neighbours";
  EXPECT_TRUE(path.at(1));
  EXPECT_TRUE(path.at(1.3)) << "a pose itself is known";
}

TEST_F(TumPosesFile, OfTwoAtOneTimeTheLastCounts) {
  EXPECT_EQ(poses("1 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n").at(1)->translation().x(), 2000);
}

TEST_F(TumPosesFile, WhatIsWrongIsToldWithItsLine) {
  EXPECT_THAT(error_with("1 0 0 0 0 0 1\n"), HasSubstr("groundtruth.txt:1: 7 words, expected TIME tx"));
  EXPECT_THAT(error_with("1 0 0 x 0 0 0 1\n"), HasSubstr("groundtruth.txt:1: 'x' is not a number"));
  EXPECT_THAT(error_with("#\n1 0 0 0 0 0 0 2\n"),
              HasSubstr("groundtruth.txt:2: the quaternion has the length 2"));
  EXPECT_THAT(error_with("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr("groundtruth.txt:2: the time 1.000000 is earlier than 2.000000"));
  EXPECT_THAT(error_with("# nothing\n"), HasSubstr("groundtruth.txt: no pose"));
}

TEST_F(TumPosesFile, BelongToTheFramesThatAreSelected) {
  make_folder("depth");
  std::string list;
  std::string path;
  for (int i = 0; i < 4; ++i) {
    write_depth(file(fmt::format("depth/{}.png", i)), slope(4001));
    list += fmt::format("{:.3f} depth/{}.png\n", 100 + i / 25.0, i);
    path += fmt::format("{:.3f} {} 0 0 0 0 0 1\n", 100.01 + i / 25.0, i);
  }
  write("depth.txt", list);
  write("groundtruth.txt", path);
  const std::string section =
      "{type: tum, folder: '" + file("") + "', fx: 50, fy: 50, cx: 19.5, cy: 14.5, first: 2}";
  const auto stream = open(section);
  ASSERT_TRUE(stream->camera_pose(1));
  EXPECT_NEAR(stream->camera_pose(1)->translation().x(), 750, 1e-6) << "of frame 2 of the folder";
  EXPECT_NEAR(stream->camera_pose(3)->translation().x(), 2750, 1e-6);
  EXPECT_FALSE(stream->camera_pose(4));
  EXPECT_THAT(stream->warnings(), IsEmpty());
  write("groundtruth.txt", std::string("5 0 0 0 0 0 0 1\n"));
  EXPECT_THAT(open(section)->warnings(),
              ::testing::Contains(AllOf(HasSubstr("no frame has a pose"), HasSubstr("100 ms"))));
}

}  // namespace
}  // namespace pliant
