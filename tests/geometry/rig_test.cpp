#include "framework/geometry/rig.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "framework/core/error.h"
#include "framework/geometry/frame.h"

namespace pliant {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// What is said of a rig with a colour camera of twice the size, and of a frame of it, once one is spoilt.
std::string complaint(const std::function<void(Rig&, Frame&)>& spoil) {
  Rig rig{{100, 100, 3.5, 2.5, 8, 6}, Camera{200, 200, 7.5, 5.5, 16, 12}};
  rig.color_from_depth = Eigen::Translation3d(25, 0, 0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  Frame frame{DepthImage(8, 6, 500), ColorImage(16, 12), MaskImage(8, 6, 1)};
  spoil(rig, frame);
  try {
    check(rig, "rig");
    check(frame, rig, "rig: its");
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(RigCheck, ColourHasTheSizeOfItsCamera) {
  EXPECT_EQ(complaint([](Rig&, Frame&) {}), "");
  EXPECT_EQ(complaint([](Rig&, Frame& frame) { frame.color = {}; }), "");
  EXPECT_EQ(complaint([](Rig&, Frame& frame) { frame.color = ColorImage(8, 6); }),
            "rig: its colour image is 8 x 6 pixels; expected the colour camera's 16 x 12");
  EXPECT_EQ(complaint([](Rig& rig, Frame&) { rig.color.reset(); }),
            "rig: its colour image is 16 x 12 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](Rig&, Frame& frame) { frame.mask = MaskImage(16, 12); }),
            "rig: its mask is 16 x 12 pixels; expected the camera's 8 x 6");
}

TEST(RigCheck, BothCamerasProject) {
  EXPECT_THAT(complaint([](Rig& rig, Frame&) { rig.depth.fx = 0; }),
              testing::StartsWith("rig: the camera's focal lengths are 0 and 100"));
  EXPECT_THAT(complaint([](Rig& rig, Frame&) { rig.color->fy = -1; }),
              testing::StartsWith("rig: the colour camera's focal lengths are 200 and -1"));
  EXPECT_THAT(complaint([](Rig& rig, Frame&) { rig.color->cx = nan; }),
              testing::StartsWith("rig: the colour camera's principal point is (nan, 5.5)"));
}

TEST(RigCheck, TheMotionBetweenTheCamerasIsRigid) {
  EXPECT_THAT(complaint([](Rig& rig, Frame&) { rig.color_from_depth.matrix()(0, 1) += 0.01; }),
              testing::HasSubstr("the motion from the depth camera to the colour camera is not rigid"));
  EXPECT_EQ(complaint([](Rig& rig, Frame&) {
              rig.color.reset();
              rig.color_from_depth.matrix().setZero();
            }).find("rigid"),
            std::string::npos)
      << "without a colour camera it plays no part";
}

TEST(IsRigid, TakesRotationsOfFewDigitsOnly) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  matrix.topRightCorner<3, 1>() = Eigen::Vector3d(50, -3, 1e4);
  EXPECT_TRUE(is_rigid(matrix));
  EXPECT_TRUE(is_rigid((matrix * 1e4).array().round() / 1e4)) << "four digits";
  const auto spoilt = [&](int row, int column, double value) {
    Eigen::Matrix4d other = matrix;
    other(row, column) = value;
    return other;
  };
  EXPECT_FALSE(is_rigid(spoilt(0, 0, -matrix(0, 0))));
  EXPECT_FALSE(is_rigid(spoilt(0, 3, nan)));
  EXPECT_FALSE(is_rigid(spoilt(3, 3, 2)));
  EXPECT_FALSE(is_rigid(spoilt(3, 0, 0.1)));
  EXPECT_FALSE(is_rigid(matrix.transpose())) << "column by column";
  Eigen::Matrix4d other = matrix;
  other.topLeftCorner<3, 3>() *= 1000;
  EXPECT_FALSE(is_rigid(other)) << "scaled";
  other = matrix;
  other.row(0) = -other.row(0);
  EXPECT_FALSE(is_rigid(other)) << "mirrored";
}

}  // namespace
}  // namespace pliant
