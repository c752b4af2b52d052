#include "framework/geometry/mesh.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace pliant {
namespace {

Mesh two_targets() {
  return {{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}},
          {{0, 1, 2}},
          {{"lift", {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}}, {"shift", {{4, 0, 0}, {4, 0, 0}, {0, 0, 0}}}}};
}

TEST(Mesh, IsAtRestWithoutWeights) {
  const Mesh mesh = two_targets();
  const auto deformed = mesh.deform({0, 0});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(deformed[i], mesh.vertices[i].cast<double>());
}

TEST(Mesh, DisplacementsAddUpByTheirWeights) {
  const auto deformed = two_targets().deform({0.5, -2});
  EXPECT_EQ(deformed[0], Eigen::Vector3d(-8, 0, 0.5));
  EXPECT_EQ(deformed[1], Eigen::Vector3d(2, 0, 1));
  EXPECT_EQ(deformed[2], Eigen::Vector3d(0, 10, 1.5));
}

TEST(Mesh, NamesItsTargetsInOrder) {
  EXPECT_THAT(two_targets().target_names(), testing::ElementsAre("lift", "shift"));
}

TEST(Mesh, RefusesListsThatDoNotFit) {
  Mesh mesh = two_targets();
  EXPECT_THROW(mesh.deform({1}), std::invalid_argument);
  EXPECT_THROW(mesh.deform({1, 2, 3}), std::invalid_argument);
  mesh.targets[1].displacements.pop_back();
  EXPECT_THROW(mesh.deform({1, 0}), std::invalid_argument);
}

/// An arm along x: an upper joint at the origin and a lower one at x = 10, which carries the vertex at x = 20
/// alone and half of the one at x = 10.
Mesh arm() {
  Mesh mesh{{{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}, {{0, 1, 2}}, {}};
  const Eigen::Affine3d lower(Eigen::Translation3d(10, 0, 0));
  mesh.joints = {{"upper", -1}, {"lower", 0, lower, lower.inverse()}};
  mesh.skin = {{{0, 0, 0, 0}, {1, 0, 0, 0}}, {{0, 1, 0, 0}, {0.5, 0.5, 0, 0}}, {{1, 0, 0, 0}, {1, 0, 0, 0}}};
  return mesh;
}

TEST(SkinnedMesh, IsAtRestInItsRestPose) {
  const Mesh mesh = arm();
  const auto deformed = mesh.deform(mesh.rest());
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT((deformed[i] - mesh.vertices[i].cast<double>()).norm(), 1e-12) << i;
}

TEST(SkinnedMesh, JointsCarryWhatHangsOnThem) {
  const Mesh mesh = arm();
  MeshPose pose = mesh.rest();
  const Eigen::Affine3d quarter(Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitZ()));
  pose.joints[1] = pose.joints[1] * quarter;  // bends the elbow
  EXPECT_LT((mesh.deform(pose)[2] - Eigen::Vector3d(10, 10, 0)).norm(), 1e-12);
  pose.joints[0] = quarter;  // and lifts the whole arm
  const auto deformed = mesh.deform(pose);
  EXPECT_LT((deformed[1] - Eigen::Vector3d(0, 10, 0)).norm(), 1e-12);
  EXPECT_LT((deformed[2] - Eigen::Vector3d(-10, 10, 0)).norm(), 1e-12);
}

TEST(SkinnedMesh, BlendsWhatSeveralJointsCarry) {
  Mesh mesh = arm();
  mesh.vertices[1] = {10, 0, 2};
  MeshPose pose = mesh.rest();
  pose.joints[1] = pose.joints[1] * Eigen::Translation3d(0, 8, 0);
  EXPECT_LT((mesh.deform(pose)[1] - Eigen::Vector3d(10, 4, 2)).norm(), 1e-12);
}

TEST(SkinnedMesh, MorphsBeforeItIsCarried) {
  Mesh mesh = arm();
  mesh.targets = {{"longer", {{0, 0, 0}, {0, 0, 0}, {5, 0, 0}}}};
  MeshPose pose = mesh.rest();
  pose.weights = {1};
  pose.joints[1] = pose.joints[1] * Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitZ());
  EXPECT_LT((mesh.deform(pose)[2] - Eigen::Vector3d(10, 15, 0)).norm(), 1e-12);
}

TEST(SkinnedMesh, RefusesListsThatDoNotFit) {
  const Mesh mesh = arm();
  MeshPose pose = mesh.rest();
  pose.joints.pop_back();
  EXPECT_THROW(mesh.deform(pose), std::invalid_argument);
  Mesh other = arm();
  other.skin.pop_back();
  EXPECT_THROW(other.deform(other.rest()), std::invalid_argument);
  other = arm();
  other.skin[2].joints[0] = 7;
  EXPECT_THROW(other.deform(other.rest()), std::invalid_argument);
  other = arm();
  other.joints[0].parent = 1;
  EXPECT_THROW(other.deform(other.rest()), std::invalid_argument);
}

}  // namespace
}  // namespace pliant
