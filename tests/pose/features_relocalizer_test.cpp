#include "framework/pose/features_relocalizer.h"

#include <gmock/gmock.h>

#include <limits>

#include "experiments/runner/components.h"
#include "framework/config/config.h"
#include "framework/core/angle.h"
#include "framework/core/error.h"
#include "framework/imaging/depth_map.h"
#include "tests/pose/lumpy_object.h"

namespace pliant {
namespace {

using test::difference;
using test::motion_of;
using test::still;
using ::testing::HasSubstr;

/// Grey of cubes of 12 mm, each of a random brightness, that go with the object.
std::uint8_t grey_at(const Eigen::Vector3d& point) {
  std::uint32_t hash = 17;
  for (const double value : point)
    hash = (hash ^ static_cast<std::uint32_t>(static_cast<int>(std::floor(value / 12)) + 1000)) * 2654435761U;
  return static_cast<std::uint8_t>(40 + (hash >> 16) % 200);
}

Frame painted(const Eigen::Isometry3d& motion) {
  Frame frame = test::seen(motion);
  frame.color = ColorImage(frame.depth.width(), frame.depth.height());
  for (int v = 0; v < frame.depth.height(); ++v) {
    for (int u = 0; u < frame.depth.width(); ++u) {
      if (!is_depth(frame.depth(u, v))) continue;
      const std::uint8_t grey = grey_at(motion.inverse() * test::camera.unproject(u, v, frame.depth(u, v)));
      frame.color(u, v) = {grey, grey, grey};
    }
  }
  return frame;
}

class FeaturesRelocalizerTest : public ::testing::Test {
 protected:
  SurfaceMap surface_of(const Frame& frame) {
    return make_surface_map(device_, DepthMap(frame), test::camera);
  }

  void remember(Relocalizer& relocalizer, bool has_color) {
    for (const Eigen::Isometry3d& pose :
         {still, motion_of(0, 20, 0, {0, 0, 0}), motion_of(-20, 0, 0, {0, 0, 0})}) {
      Frame frame = painted(pose);
      if (!has_color) frame.color = {};
      relocalizer.remember(frame, surface_of(frame), pose);
    }
  }

  /// How far the best of the candidates is from a pose, mm.
  double error_of(const std::vector<Eigen::Isometry3d>& candidates, const Eigen::Isometry3d& pose) {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Isometry3d& candidate : candidates)
      least = std::min(least, difference(candidate, pose));
    return least;
  }

  Device device_;
  FeaturesRelocalizer relocalizer_{Rig{test::camera}, {}};
};

const Eigen::Isometry3d far_away = motion_of(-12, 22, 10, {50, -30, 60});

TEST_F(FeaturesRelocalizerTest, FindsAFarPoseByColor) {
  remember(relocalizer_, true);
  const Frame frame = painted(far_away);
  const auto candidates = relocalizer_.candidates(frame, surface_of(frame));
  ASSERT_FALSE(candidates.empty());
  EXPECT_LT(difference(candidates.front(), far_away), 10);
  EXPECT_GT(difference(still, far_away), 100);
}

TEST_F(FeaturesRelocalizerTest, FindsItByFormWithoutColor) {
  remember(relocalizer_, false);
  const Frame frame = test::seen(far_away);
  EXPECT_LT(error_of(relocalizer_.candidates(frame, surface_of(frame)), far_away), 40)
      << "from where ICP goes on";
}

TEST_F(FeaturesRelocalizerTest, FindsItByFormWhereTheKeyframesHadColorAndTheFrameHasNone) {
  remember(relocalizer_, true);
  const Frame frame = test::seen(far_away);
  EXPECT_LT(error_of(relocalizer_.candidates(frame, surface_of(frame)), far_away), 40);
}

TEST_F(FeaturesRelocalizerTest, TheSameCallsGiveTheSameBits) {
  FeaturesRelocalizer again(Rig{test::camera}, {});
  remember(relocalizer_, true);
  remember(again, true);
  const Frame frame = painted(far_away);
  const auto once = relocalizer_.candidates(frame, surface_of(frame));
  const auto twice = again.candidates(frame, surface_of(frame));
  ASSERT_EQ(once.size(), twice.size());
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].matrix(), twice[i].matrix());
}

TEST_F(FeaturesRelocalizerTest, NamesNothingWithoutKeyframesOrSurface) {
  const Frame frame = painted(far_away);
  EXPECT_TRUE(relocalizer_.candidates(frame, surface_of(frame)).empty());
  Frame empty = frame;
  empty.depth = DepthImage(frame.depth.width(), frame.depth.height(), 0);
  const SurfaceMap nothing = unwritten_surface(test::camera, {0, 0, 0, 0});
  relocalizer_.remember(empty, nothing, still);
  EXPECT_TRUE(relocalizer_.candidates(frame, surface_of(frame)).empty())
      << "it was a frame without a surface";
  remember(relocalizer_, true);
  EXPECT_TRUE(relocalizer_.candidates(empty, nothing).empty());
}

TEST(Keyframes, AreApartByDistanceOrAngle) {
  Keyframes keyframes({10, 50, 10 * degree}, test::middle());
  EXPECT_TRUE(keyframes.wants(still));
  keyframes.add({still, {}, {}});
  EXPECT_FALSE(keyframes.wants(motion_of(0, 9, 0, {49, 0, 0})));
  EXPECT_TRUE(keyframes.wants(motion_of(0, 0, 0, {51, 0, 0})));
  EXPECT_TRUE(keyframes.wants(motion_of(0, 11, 0, {0, 0, 0}))) << "about the middle, which stays";
}

TEST(Keyframes, TheOlderOfTheNearestTwoGoes) {
  Keyframes keyframes({3, 50, 10 * degree}, test::middle());
  for (const double place : {0.0, 500.0, 560.0, 1200.0})
    keyframes.add({motion_of(0, 0, 0, {place, 0, 0}), {}, {}});
  ASSERT_EQ(keyframes.all().size(), 3U);
  EXPECT_TRUE(keyframes.wants(motion_of(0, 0, 0, {500, 0, 0}))) << "it went";
  for (const double place : {0.0, 560.0, 1200.0})
    EXPECT_FALSE(keyframes.wants(motion_of(0, 0, 0, {place, 0, 0}))) << place;
}

TEST(FeaturesRelocalizerSection, OutOfRangeIsAConfigError) {
  Registry registry;
  register_everything(registry);
  const auto error_of = [&](const std::string& section) -> std::string {
    try {
      load_experiment({ConfigText{"relocalizer: " + section, "the text", {}}, {}, {}},
                      {component("relocalizer", RelocalizerKind::kind)}, registry);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of("{type: features, keyframes: 1}"), HasSubstr("'relocalizer.keyframes' is"));
  EXPECT_THAT(error_of("{type: features, ratio: 1.5}"), HasSubstr("'relocalizer.ratio' is"));
  EXPECT_THAT(error_of("{type: features, inlier_distance: 0}"),
              HasSubstr("'relocalizer.inlier_distance' is"));
  EXPECT_THAT(error_of("feature"), HasSubstr("features"));
  EXPECT_EQ(error_of("{type: features, keyframes: 2}"), "");
}

}  // namespace
}  // namespace pliant
