#include "framework/pose/focal_length.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <random>

#include "framework/imaging/depth_map.h"
#include "framework/pose/focal_length_equation.h"
#include "framework/pose/projective_icp.h"
#include "framework/pose/rigid_equation.h"
#include "tests/device/shapes.h"
#include "tests/pose/lumpy_object.h"

namespace pliant {
namespace {

using test::camera;
using test::motion_of;
using test::seen;
using test::still;

/// What a camera of a wrong focal length takes frames of the right one for.
Camera scaled(double factor) {
  Camera wrong = camera;
  wrong.fx *= factor;
  wrong.fy *= factor;
  return wrong;
}

/// A point at a pixel, with its depth, has the greater an x and y the smaller the focal length is.
TEST(FocalLengthEquation, DerivativeIsThatOfPointsThatBothViewsBackProject) {
  using Jet = ceres::Jet<double, 1>;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-100, 100);
  const auto draw = [&] { return Eigen::Vector3d(side(random), side(random), side(random)); };
  for (int round = 0; round < 100; ++round) {
    const Eigen::Vector3d p = draw() + Eigen::Vector3d(0, 0, 600);
    const Eigen::Vector3d before = draw().normalized();
    const Eigen::Isometry3d motion = motion_of(20, -30, 10, draw());
    const Eigen::Vector3d moved = motion * p;
    const Eigen::Vector3d own = motion.linear() * before;
    const Jet shrunk = 1.0 / (1.0 + Jet(0, 0));
    const Eigen::Matrix<Jet, 3, 1> first(p.x() * shrunk, p.y() * shrunk, Jet(p.z()));
    const Eigen::Matrix<Jet, 3, 1> match(moved.x() * shrunk, moved.y() * shrunk, Jet(moved.z()));
    const Eigen::Matrix<Jet, 3, 1> away = motion.linear().cast<Jet>() * first - match;
    const Eigen::Matrix<Jet, 3, 1> normal = own.cast<Jet>();
    const Jet expected = plane_distance(away.data(), normal.data());
    EXPECT_NEAR(plane_distance_by_focal_length(p.data(), before.data(), moved.data(), own.data()),
                expected.v[0], 1e-9);
  }
}

class FocalLengthMatching : public testing::TestWithParam<DeviceOptions> {};

INSTANTIATE_TEST_SUITE_P(Shapes, FocalLengthMatching, testing::ValuesIn(test::device_shapes));

TEST_P(FocalLengthMatching, IsThatOfItsReference) {
  Device device("any", GetParam());
  const SurfaceMap first = make_surface_map(device, DepthMap(seen(still)), scaled(0.9));
  const SurfaceMap view =
      make_surface_map(device, DepthMap(seen(motion_of(4, -6, 3, {6, -4, 9}))), scaled(0.9));
  const Eigen::Isometry3d pose = motion_of(3, -5, 2, {5, -4, 8});
  const FocalLengthEquations found = FocalLengthCheck(device, first).equations(view, pose);
  const FocalLengthEquations expected =
      focal_length_equations_reference(first, view, pose, found.motion.pivot);
  // Rounding may put a point into the next pixel, and a match beyond a limit.
  constexpr double few_pixels = 5e-3;
  EXPECT_GT(expected.motion.matches, 1000);
  EXPECT_NEAR(found.motion.matches, expected.motion.matches, 3);
  EXPECT_LT((found.motion.JtJ - expected.motion.JtJ).norm(), few_pixels * expected.motion.JtJ.norm());
  EXPECT_LT((found.motion.Jtr - expected.motion.Jtr).norm(), few_pixels * expected.motion.Jtr.norm());
  EXPECT_LT((found.mixed - expected.mixed).norm(), few_pixels * expected.mixed.norm());
  EXPECT_NEAR(found.curvature, expected.curvature, few_pixels * expected.curvature);
  EXPECT_NEAR(found.gradient, expected.gradient, few_pixels * std::abs(expected.gradient));
}

/// After the object was seen from several sides.
FocalLengthEstimate estimate_with(double factor, const Eigen::Vector3d& axis) {
  Device device;
  const SurfaceMap first = make_surface_map(device, DepthMap(seen(still)), scaled(factor));
  FocalLengthCheck check(device, first);
  ProjectiveIcp icp(device, {});
  Eigen::Isometry3d pose = still;
  for (int turn = 3; turn <= 18; turn += 3) {
    const Eigen::Vector3d by = turn * axis;
    const SurfaceMap view = make_surface_map(
        device, DepthMap(seen(motion_of(by.x(), by.y(), by.z(), {0, 0, 0}))), scaled(factor));
    const PoseEstimate found = icp.estimate(first, view, pose);
    EXPECT_FALSE(found.failed) << found.reason;
    pose = found.target_from_source;
    check.add(view, pose);
  }
  return check.estimate();
}

TEST(FocalLengthCheck, FindsTheRightOne) {
  const FocalLengthEstimate right = estimate_with(1, {0, 1, 0});
  EXPECT_EQ(right.views, 6);
  EXPECT_NEAR(right.change, 0, 0.01);
  EXPECT_FALSE(right.is_wrong());
  for (const double factor : {0.85, 0.9, 1.1, 1.15}) {
    const FocalLengthEstimate wrong = estimate_with(factor, {0.6, 0.8, 0});
    EXPECT_NEAR(wrong.change, 1 / factor - 1, 0.3 * std::abs(1 / factor - 1)) << factor;
    EXPECT_TRUE(wrong.is_wrong()) << factor << ": " << wrong.change << " +- " << wrong.error;
  }
}

TEST(FocalLengthCheck, IsNotToldByACameraThatTurnsAboutItsAxis) {
  const FocalLengthEstimate estimate = estimate_with(0.85, {0, 0, 1});
  EXPECT_EQ(estimate.views, 0);
  EXPECT_FALSE(estimate.is_wrong());
}

/// A plane that is stretched is one: some motion explains any focal length.
TEST(FocalLengthCheck, IsNotToldByAPlane) {
  Device device;
  const auto plane = [](const Eigen::Isometry3d& motion) {
    const Eigen::Hyperplane<double, 3> wall(motion.linear().col(2), motion * test::middle());
    Frame frame{DepthImage(camera.width, camera.height), {}, {}};
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u)
        frame.depth(u, v) =
            static_cast<float>(-wall.offset() / wall.normal().dot(camera.unproject(u, v, 1.0)));
    return frame;
  };
  const SurfaceMap first = make_surface_map(device, DepthMap(plane(still)), scaled(0.8));
  FocalLengthCheck check(device, first);
  for (int turn = 3; turn <= 24; turn += 3) {
    const Eigen::Isometry3d motion = motion_of(0, turn, 0, {0, 0, 0});
    check.add(make_surface_map(device, DepthMap(plane(motion)), scaled(0.8)), motion);
  }
  EXPECT_EQ(check.estimate().views, 8);
  EXPECT_FALSE(check.estimate().is_wrong()) << check.estimate().change << " +- " << check.estimate().error;
}

TEST(FocalLengthEstimate, IsWrongWhereEnoughViewsSayForSureThatItIsFarOff) {
  EXPECT_TRUE((FocalLengthEstimate{-0.1, 0.03, 5}.is_wrong()));
  EXPECT_FALSE((FocalLengthEstimate{-0.1, 0.03, 4}.is_wrong())) << "few views";
  EXPECT_FALSE((FocalLengthEstimate{-0.1, 0.04, 5}.is_wrong())) << "unsure";
  EXPECT_FALSE((FocalLengthEstimate{-0.04, 0.001, 50}.is_wrong())) << "small";
}

TEST(FocalLengthCheck, OfNothingIsNoWarning) {
  Device device;
  const SurfaceMap nothing =
      make_surface_map(device, DepthMap(Frame{DepthImage(camera.width, camera.height, 0), {}, {}}), camera);
  FocalLengthCheck check(device, nothing);
  check.add(nothing, motion_of(0, 10, 0, {0, 0, 0}));
  EXPECT_EQ(check.estimate().views, 0);
  EXPECT_EQ(check.estimate().change, 0);
}

}  // namespace
}  // namespace pliant
