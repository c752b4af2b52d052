#include "experiments/modeller/skeleton.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/modeller/figures.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

/// Points along a stick with a hinge in its middle.
Mesh hinged_stick() {
  Mesh mesh;
  for (int y = 0; y <= 100; ++y) mesh.vertices.emplace_back(5, y, 0);
  Skeleton skeleton;
  skeleton.add("lower", "", {{0, 0, 0}, {0, 50, 0}, 5}, 10)
      .add("upper", "lower", {{0, 50, 0}, {0, 100, 0}, 5}, 10);
  skeleton.bind(mesh);
  return mesh;
}

TEST(Skeleton, WeightsGoSmoothlyFromJointToJoint) {
  const Mesh mesh = hinged_stick();
  ASSERT_EQ(mesh.joints.size(), 2U);
  double last = 0;
  for (const JointWeights& skin : mesh.skin) {
    EXPECT_NEAR(skin.weights.sum(), 1, 1e-6);
    double upper = 0;
    for (int k = 0; k < 4; ++k) upper += skin.joints[k] == 1 ? skin.weights[k] : 0;
    EXPECT_GE(upper, last - 1e-6);
    EXPECT_LT(upper - last, 0.15);
    last = upper;
  }
  EXPECT_EQ(mesh.skin.front().weights[0], 1);
  EXPECT_EQ(mesh.skin.front().joints[0], 0);
  EXPECT_NEAR(last, 1, 1e-6);
}

TEST(Skeleton, ATurnAboutXBendsToTheFront) {
  const Mesh mesh = hinged_stick();
  const NamedPose bent{"bent", "", {}, {{"upper", {90, 0, 0}}}};
  const auto points = test::posed(mesh, bent);
  EXPECT_LT((points.back() - Point(5, 50, 50)).norm(), 1e-4);
  EXPECT_LT((points.front() - Point(5, 0, 0)).norm(), 1e-4);
  const auto half = test::posed(mesh, bent, 0.5);
  EXPECT_NEAR(half.back().z(), 50 * std::sqrt(0.5), 1e-4);
}

TEST(Skeleton, TurnsAreAboutXThenYThenZ) {
  const Mesh mesh = hinged_stick();
  const auto points = test::posed(mesh, {"odd", "", {}, {{"upper", {90, 90, 0}}}});
  // The tip goes from y to z by the first turn and from z to x by the second; what lies at x goes to -z.
  EXPECT_LT((points.back() - Point(50, 50, -5)).norm(), 1e-4);
}

TEST(Skeleton, AParentMustHaveBeenAdded) {
  Skeleton skeleton;
  EXPECT_THROW(skeleton.add("hand", "arm", {{0, 0, 0}, {0, 1, 0}, 1}, 1), std::logic_error);
}

}  // namespace
}  // namespace pliant
