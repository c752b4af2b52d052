#include "framework/tracking/followed_window.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

const Camera kCamera{500, 500, 319.5, 239.5, 640, 480};
const PixelWindow kFound{270, 180, 100, 120};  // its middle is that of the image

Eigen::Isometry3d shifted(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

FollowedWindow window_at(double depth) { return {kCamera, kFound, depth, Eigen::Isometry3d::Identity()}; }

TEST(FollowedWindow, MovesWithTheObject) {
  FollowedWindow window = window_at(1000);
  EXPECT_EQ(window.move_to(Eigen::Isometry3d::Identity()), kFound);
  EXPECT_EQ(window.move_to(shifted(100, -40, 0)), (PixelWindow{320, 160, 100, 120}));
  EXPECT_EQ(window.move_to(Eigen::Isometry3d::Identity()), kFound);
}

TEST(FollowedWindow, GrowsByMoreThanIsNeededAndNeverShrinks) {
  FollowedWindow window = window_at(1000);
  const PixelWindow nearer = window.move_to(shifted(0, 0, -200));  // 125 and 150 pixels are needed
  EXPECT_EQ(nearer.width, 141);
  EXPECT_EQ(nearer.height, 169);
  const PixelWindow nearer_still = window.move_to(shifted(0, 0, -250));
  EXPECT_EQ(nearer_still.width, nearer.width);
  const PixelWindow back = window.move_to(Eigen::Isometry3d::Identity());
  EXPECT_EQ(back.width, nearer.width);
  EXPECT_EQ(back.height, nearer.height);
}

TEST(FollowedWindow, StaysInsideTheImage) {
  FollowedWindow window = window_at(1000);
  EXPECT_EQ(window.move_to(shifted(5000, 0, 0)), (PixelWindow{540, 180, 100, 120}));
  EXPECT_EQ(window.move_to(shifted(-5000, 5000, 0)), (PixelWindow{0, 360, 100, 120}));
  EXPECT_EQ(window.move_to(shifted(0, 0, -940)), (PixelWindow{0, 0, 640, 480}));
}

TEST(FollowedWindow, StaysWhereItIsForWhatIsBehindTheCamera) {
  FollowedWindow window = window_at(1000);
  const PixelWindow before = window.move_to(shifted(100, 0, 0));
  EXPECT_EQ(window.move_to(shifted(0, 0, -1200)), before);
}

TEST(FollowedWindow, CoversWhatIsFound) {
  FollowedWindow window = window_at(1000);
  EXPECT_EQ(window.move_to(PixelWindow{10, 20, 60, 80}), (PixelWindow{0, 0, 100, 120}));
  EXPECT_EQ(window.move_to(PixelWindow{300, 200, 160, 120}), (PixelWindow{290, 200, 180, 120}));
}

}  // namespace
}  // namespace pliant
