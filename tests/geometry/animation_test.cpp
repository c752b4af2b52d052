#include "framework/geometry/animation.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "framework/core/angle.h"

namespace pliant {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using Interpolation = Track::Interpolation;

Eigen::Quaterniond about_z(double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * degree, Eigen::Vector3d::UnitZ()));
}

TEST(Track, HoldsBeforeItsFirstKeyAndAfterItsLast) {
  for (const auto kind : {Interpolation::step, Interpolation::linear}) {
    const Track track{kind, 2, {1, 2}, {1, 10, 3, 30}};
    EXPECT_THAT(track.at(-5), ElementsAre(1, 10));
    EXPECT_THAT(track.at(1), ElementsAre(1, 10));
    EXPECT_THAT(track.at(2), ElementsAre(3, 30));
    EXPECT_THAT(track.at(9), ElementsAre(3, 30));
  }
}

TEST(Track, StepsOrGoesStraight) {
  EXPECT_THAT((Track{Interpolation::step, 1, {1, 2}, {1, 3}}.at(1.9)), ElementsAre(1));
  EXPECT_THAT((Track{Interpolation::linear, 1, {1, 3}, {1, 3}}.at(1.5)), ElementsAre(DoubleNear(1.5, 1e-12)));
}

TEST(Track, CubicOnesFollowAnyCubicPolynomial) {
  const auto polynomial = [](double t) { return t * t * t - 2 * t * t + 3; };
  const auto slope = [](double t) { return 3 * t * t - 4 * t; };
  Track track{Interpolation::cubic, 1, {0.5, 2, 2.5}, {}};
  for (const double t : track.times)
    track.values.insert(track.values.end(), {slope(t), polynomial(t), slope(t)});
  for (double t = 0.5; t < 2.5; t += 0.1) EXPECT_NEAR(track.at(t)[0], polynomial(t), 1e-12) << t;
  EXPECT_NEAR(track.at(3)[0], polynomial(2.5), 1e-12);
}

TEST(Track, RotationsGoTheShorterWayAtConstantSpeed) {
  const Eigen::Quaterniond end = about_z(120);
  for (const double sign : {1.0, -1.0}) {  // both are the same rotation
    const Track track{Interpolation::linear, 4, {0, 3}, {0, 0, 0, 1, 0, 0, sign * end.z(), sign * end.w()}};
    EXPECT_LT(track.rotation_at(1).angularDistance(about_z(40)), 1e-9);
    EXPECT_LT(track.rotation_at(2).angularDistance(about_z(80)), 1e-9);
  }
}

TEST(Track, CubicRotationsHaveUnitLength) {
  const Eigen::Quaterniond end = about_z(120);
  const Track track{Interpolation::cubic, 4, {0, 1}, {0, 0, 0, 0, 0, 0, 0,       1,       0, 0, 0, 0,
                                                      0, 0, 0, 0, 0, 0, end.z(), end.w(), 0, 0, 0, 0}};
  EXPECT_NEAR(track.rotation_at(0.5).norm(), 1, 1e-12);
  EXPECT_LT(track.rotation_at(0.5).angularDistance(about_z(60)), 1e-9);
}

Mesh two_joints() {
  Mesh mesh{
      {Eigen::Vector3f::Zero()}, {}, {{"a", {Eigen::Vector3f::UnitX()}}, {"b", {Eigen::Vector3f::UnitY()}}}};
  Joint joint{"root", -1, Eigen::Affine3d(Eigen::Translation3d(1, 2, 3))};
  mesh.joints = {joint, {"child", 0}};
  mesh.skin = {JointWeights{}};
  return mesh;
}

TEST(Animation, MovesWhatItHasTracksForAndNothingElse) {
  const Mesh mesh = two_joints();
  Animation animation;
  JointMotion motion;
  motion.joint = 1;
  motion.translation = Eigen::Vector3d(5, 0, 0);
  motion.scales = Track{Interpolation::linear, 3, {0, 1}, {1, 1, 1, 3, 3, 3}};
  animation.joints.push_back(motion);
  animation.weights.push_back({{1}, Track{Interpolation::step, 1, {0}, {0.25}}});
  const MeshPose pose = animation.pose(mesh, 0.5);
  EXPECT_EQ(pose.joints[0].matrix(), mesh.joints[0].rest.matrix());
  EXPECT_TRUE((pose.joints[1] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(7, 0, 0)));
  EXPECT_THAT(pose.weights, ElementsAre(0, 0.25));
}

TEST(Animation, TurnsAfterScalingAndShiftsLast) {
  JointMotion motion;
  motion.translation = Eigen::Vector3d(0, 0, 1);
  motion.rotation = about_z(90);
  motion.scale = Eigen::Vector3d(2, 1, 1);
  EXPECT_TRUE((motion.at(0) * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, 2, 1)));
}

TEST(Animation, OfAnotherMeshIsRefused) {
  Animation animation;
  animation.joints.emplace_back().joint = 2;
  EXPECT_THROW(animation.pose(two_joints(), 0), std::invalid_argument);
  animation.joints.clear();
  animation.weights.push_back({{2}, Track{Interpolation::step, 1, {0}, {1}}});
  EXPECT_THROW(animation.pose(two_joints(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
