#include "experiments/datasets/figure_pose.h"

#include <gmock/gmock.h>

#include "framework/core/error.h"

namespace pliant {
namespace {

using testing::HasSubstr;

/// A finger of two bones along y and a lip.
Figure finger() {
  Figure figure;
  figure.mesh.vertices = {{0, 0, 0}, {0, 10, 0}, {0, 20, 0}};
  figure.mesh.targets = {{"open", {{0, 0, 0}, {0, 0, 2}, {0, 0, 4}}}};
  Joint tip{"tip", 0};
  tip.rest.translation().y() = 10;
  tip.joint_from_mesh.translation().y() = -10;
  figure.mesh.joints = {{"base"}, tip};
  figure.mesh.skin = {
      {{0, 0, 0, 0}, {1, 0, 0, 0}}, {{0, 0, 0, 0}, {1, 0, 0, 0}}, {{1, 0, 0, 0}, {1, 0, 0, 0}}};
  figure.poses = {{"bend", "bends", {{"open", 0.5}}, {{"tip", {90, 0, 0}}}}};
  return figure;
}

std::string error_of(const std::vector<std::string>& words) {
  try {
    read_pose(finger(), words, "a.yaml:3:1: 'target' of finger");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FigurePose, AddsUpWhatWordsSay) {
  const FigurePose pose = read_pose(finger(), {"bend=0.5", "open=1", "tip.x=10", "base.z=-5"}, "test");
  EXPECT_THAT(pose.weights, testing::ElementsAre(1.25));
  EXPECT_EQ(pose.degrees[1], Eigen::Vector3d(55, 0, 0));
  EXPECT_EQ(pose.degrees[0], Eigen::Vector3d(0, 0, -5));
}

TEST(FigurePose, TurnsJointsAboutTheirOwnAxes) {
  const Figure figure = finger();
  const auto bent = figure.mesh.deform(on_top(figure.mesh.rest(), read_pose(figure, {"tip.x=90"}, "test")));
  EXPECT_TRUE(bent[1].isApprox(Eigen::Vector3d(0, 10, 0)));
  EXPECT_TRUE(bent[2].isApprox(Eigen::Vector3d(0, 10, 10), 1e-9)) << bent[2].transpose();
  // First about x, then about y.
  const auto turned =
      figure.mesh.deform(on_top(figure.mesh.rest(), read_pose(figure, {"tip.x=90", "tip.y=90"}, "test")));
  EXPECT_TRUE(turned[2].isApprox(Eigen::Vector3d(10, 10, 0), 1e-9)) << turned[2].transpose();
}

TEST(FigurePose, HalfWayIsHalfOfEverything) {
  const Figure figure = finger();
  const FigurePose pose =
      between(rest_of(figure.mesh), read_pose(figure, {"open=1", "tip.x=40"}, "test"), 0.5);
  EXPECT_DOUBLE_EQ(pose.weights[0], 0.5);
  EXPECT_DOUBLE_EQ(pose.degrees[1].x(), 20);
}

TEST(FigurePose, WhatIsNoPoseIsAnErrorThatNamesTheNearest) {
  EXPECT_THAT(error_of({"bnd=1"}), HasSubstr("a.yaml:3:1: 'target' of finger names 'bnd'"));
  EXPECT_THAT(error_of({"bnd=1"}), HasSubstr("expected one of bend, open, base.x"));
  EXPECT_THAT(error_of({"bnd=1"}), HasSubstr("did you mean 'bend'?"));
  EXPECT_THAT(error_of({"tipp.x=1"}), HasSubstr("did you mean 'tip.x'?"));
  EXPECT_THAT(error_of({"tip.w=1"}), HasSubstr("names 'tip.w'"));
  EXPECT_THAT(error_of({"bend"}), HasSubstr("has 'bend'; expected name=value, as in smile=0.5"));
  EXPECT_THAT(error_of({"bend=much"}), HasSubstr("expected name=value"));
  EXPECT_THAT(error_of({"bend=nan"}), HasSubstr("expected name=value"));
  EXPECT_THAT(error_of({"bend=1", "bend=2"}), HasSubstr("gives 'bend' twice"));
}

}  // namespace
}  // namespace pliant
