#include "framework/evaluation/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "framework/core/angle.h"
#include "framework/core/error.h"

namespace pliant {
namespace {

Eigen::Isometry3d pose_of(const Eigen::Vector3d& place, double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Translation3d(place) * Eigen::AngleAxisd(degrees * degree, axis.normalized());
}

/// A loop that turns about several axes.
Trajectory loop(int count = 40) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double way = 2 * std::numbers::pi * i / count;
    trajectory.push_back(
        {i / 30.0, pose_of({300 * std::cos(way), 200 * std::sin(way), 50 * std::sin(2 * way)},
                           40 * std::sin(way), {1, 2, std::cos(way)})});
  }
  return trajectory;
}

Trajectory moved(const Eigen::Isometry3d& motion, Trajectory trajectory) {
  for (TimedPose& pose : trajectory) pose.pose = motion * pose.pose;
  return trajectory;
}

void expect_error(const TrajectoryError& error, double translation, double rotation, int count) {
  EXPECT_NEAR(error.translation, translation, 1e-6);
  EXPECT_NEAR(error.rotation, rotation, 1e-5);
  EXPECT_EQ(error.count, count);
}

TEST(TrajectoryError, IsNoneInAnotherFrameOfReference) {
  const Trajectory estimate = moved(pose_of({10, 2000, -30}, 75, {1, 1, 0}), loop());
  for (const auto alignment : {TrajectoryAlignment::rigid, TrajectoryAlignment::first})
    expect_error(absolute_error(estimate, loop(), alignment), 0, 0, 40);
  expect_error(relative_error(estimate, loop()), 0, 0, 39);
}

TEST(TrajectoryError, OfOneStepIsThatOfAllBehindItWhereFirstPosesAreOne) {
  Trajectory estimate = loop();
  for (std::size_t i = 20; i < 40; ++i) {
    estimate[i].pose.pretranslate(Eigen::Vector3d(0, 3, 4));
    estimate[i].pose.rotate(Eigen::AngleAxisd(2 * degree, Eigen::Vector3d::UnitX()));
  }
  expect_error(absolute_error(estimate, loop(), TrajectoryAlignment::first), 5 / std::sqrt(2), std::sqrt(2),
               40);
  const TrajectoryError rigid = absolute_error(estimate, loop(), TrajectoryAlignment::rigid);
  EXPECT_LT(rigid.translation, 2.6) << "half of it is aligned away";
  EXPECT_GT(rigid.translation, 1.5);
}

TEST(TrajectoryError, OfOrientationsDoesNotDependOnWhetherPlacesTellATurn) {
  Trajectory truth = loop();
  for (TimedPose& pose : truth) pose.pose.translation().setZero();
  Trajectory estimate = moved(pose_of({0, 0, 0}, 30, {0, 0, 1}), truth);
  expect_error(absolute_error(estimate, truth, TrajectoryAlignment::rigid), 0, 0, 40);
  for (std::size_t i = 0; i < 40; ++i)
    estimate[i].pose.rotate(Eigen::AngleAxisd((i % 2 == 0 ? 1 : -1) * degree, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(absolute_error(estimate, truth, TrajectoryAlignment::rigid).rotation, 1, 0.05);
}

TEST(TrajectoryError, RelativeOfADriftIsTheDriftAStep) {
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 10; ++i) {
    truth.push_back({i / 30.0, pose_of({10.0 * i, 0, 0}, 0, {1, 0, 0})});
    estimate.push_back({i / 30.0, pose_of({10.5 * i, 0, 0}, 0, {1, 0, 0})});
  }
  expect_error(relative_error(estimate, truth), 0.5, 0, 9);
  expect_error(relative_error(estimate, truth, 4), 2, 0, 6);
}

TEST(TrajectoryError, ComparesWhatIsNearestInTime) {
  Trajectory estimate = loop();
  for (TimedPose& pose : estimate) pose.time += 0.004;
  estimate.erase(estimate.begin() + 3, estimate.begin() + 10);
  estimate.push_back({99, Eigen::Isometry3d::Identity()});
  expect_error(absolute_error(estimate, loop(), TrajectoryAlignment::first), 0, 0, 33);
  EXPECT_THROW(absolute_error(estimate, loop(), TrajectoryAlignment::first, 0.001), DataError);
  EXPECT_THROW(absolute_error({}, loop(), TrajectoryAlignment::first), DataError);
  EXPECT_THROW(absolute_error(estimate, {}, TrajectoryAlignment::first), DataError);
  EXPECT_THROW(relative_error(loop(5), loop(5), 5), DataError);
}

}  // namespace
}  // namespace pliant
