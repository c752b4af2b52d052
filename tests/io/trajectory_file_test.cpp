#include "framework/io/trajectory_file.h"

#include <gmock/gmock.h>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;

class TrajectoryFile : public test::TestFiles {};

TEST_F(TrajectoryFile, ReadsWhatWasWritten) {
  Trajectory written;
  for (const double time : {0.0, 1305031102.175304, 1305031102.211214})
    written.push_back({time, Eigen::Translation3d(1.25 + time / 1e9, -2, 3000.5) *
                                 Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized())});
  write_trajectory(file("a.txt"), written);
  const Trajectory read = read_trajectory(file("a.txt"));
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].time, written[i].time, 1e-6);
    EXPECT_LT((read[i].pose.translation() - written[i].pose.translation()).norm(), 2e-4);
    EXPECT_LT((read[i].pose.linear() - written[i].pose.linear()).norm(), 1e-7);
  }
}

TEST_F(TrajectoryFile, CountsInMetresAndPutsTheRealPartLast) {
  const Eigen::Isometry3d pose = Eigen::Translation3d(1000, 0, -250) * Eigen::Quaterniond(0.8, 0.6, 0, 0);
  EXPECT_EQ(trajectory_line({1.5, pose}),
            "1.500000 1.0000000 0.0000000 -0.2500000 0.60000000 0.00000000 0.00000000 0.80000000\n");
}

TEST_F(TrajectoryFile, IsReadWithCommentsAndRoundedNumbers) {
  const auto read =
      read_trajectory(write("a.txt", std::string("# time tx ty\n\n1.5 1 0 0 0 0 0.7071 0.7071\n")));
  ASSERT_EQ(read.size(), 1U);
  EXPECT_NEAR((read[0].pose.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0, 1e-6);
}

TEST_F(TrajectoryFile, WhatIsNoTrajectoryIsToldWithItsLine) {
  const auto error_of = [&](const std::string& text) {
    return data_error_of([&] { read_trajectory(write("a.txt", text)); });
  };
  const std::string path = file("a.txt");
  EXPECT_EQ(error_of("0 0 0 0 0 0 0 1\n1 2 3\n"), path + ":2: 3 words, expected TIME TX TY TZ QX QY QZ QW");
  EXPECT_EQ(error_of("0 0 0 0 0 0 0 2\n"), path + ":1: the quaternion has length 2, expected 1");
  EXPECT_EQ(error_of("0 0 0 0 0 0 0 0\n"), path + ":1: the quaternion has length 0, expected 1");
  EXPECT_EQ(error_of("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
            path + ":2: the time 1.000000 is not later than 1.000000 in the line before");
  EXPECT_EQ(error_of("0 0 x 0 0 0 0 1\n"), path + ":1: 'x' is not a number");
  EXPECT_EQ(error_of("# nothing\n"), path + ": no pose");
}

}  // namespace
}  // namespace pliant
