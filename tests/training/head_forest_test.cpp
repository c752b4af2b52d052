#include <gmock/gmock.h>

#include "experiments/training/head_forest_training.h"
#include "experiments/training/head_trial.h"
#include "framework/core/error.h"
#include "framework/pose/head_relocalizer.h"

namespace pliant {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

HeadForestTraining tiny_training() {
  HeadForestTraining training;
  training.heads = 1;
  training.views = 24;
  training.other_views = 8;
  training.view.nearest = 600;
  training.view.farthest = 800;
  training.view.company = 0;
  training.voting = {1, 8, {.tests = 20}};
  training.refining = {2, 8, {.tests = 20}};
  return training;
}

const Bytes& tiny_forest() {
  static const Bytes bytes =
      write_head_forest(grow_head_forest(draw_head_patches(tiny_training()), tiny_training()));
  return bytes;
}

std::string complaint(const Bytes& bytes) {
  try {
    read_head_forest(bytes, "a.forest");
  } catch (const DataError& error) {
    return error.what();
  }
  return "none";
}

TEST(HeadForestFileTest, WhatIsReadIsWhatWasWritten) {
  const HeadForest forest = read_head_forest(tiny_forest(), "a.forest");
  EXPECT_EQ(forest.voting.size(), 1U);
  EXPECT_EQ(forest.refining.size(), 2U);
  EXPECT_EQ(write_head_forest(forest), tiny_forest());
}

TEST(HeadForestFileTest, EveryTruncationIsTold) {
  for (std::size_t size = 0; size < tiny_forest().size(); size += size < 64 ? 1 : 97) {
    const Bytes part(tiny_forest().begin(), tiny_forest().begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THAT(complaint(part), HasSubstr("a.forest: ")) << size;
  }
  const Bytes half(tiny_forest().begin(),
                   tiny_forest().begin() + static_cast<std::ptrdiff_t>(tiny_forest().size() / 2));
  EXPECT_THAT(complaint(half), HasSubstr("truncated"));
}

TEST(HeadForestFileTest, OtherFilesVersionsAndDamageAreTold) {
  EXPECT_THAT(complaint({'p', 'l', 'y', '\n', 1, 2, 3, 4, 5}), HasSubstr("no head forest"));
  Bytes other = tiny_forest();
  other[8] = 7;
  EXPECT_THAT(complaint(other), HasSubstr("version 7; expected 1"));
  Bytes damaged = tiny_forest();
  damaged.back() ^= 1;
  EXPECT_THAT(complaint(damaged), HasSubstr("checksum"));
  Bytes longer = tiny_forest();
  longer.push_back(0);
  EXPECT_THAT(complaint(longer), HasSubstr("followed by something else"));
}

TEST(HeadForestTest, TheSameTrainingGivesTheSameBytesAndAnotherSeedOthers) {
  EXPECT_EQ(write_head_forest(grow_head_forest(draw_head_patches(tiny_training()), tiny_training())),
            tiny_forest());
  HeadForestTraining other = tiny_training();
  other.seed = 2;
  EXPECT_NE(write_head_forest(grow_head_forest(draw_head_patches(other), other)), tiny_forest());
}

TEST(HeadForestTest, AnglesAndRotationsFitEachOther) {
  const Eigen::Vector3d angles(0.8, -0.5, 0.3);
  EXPECT_TRUE(head_angles(head_rotation(angles)).isApprox(angles, 1e-12));
  const Eigen::Vector3d gaze = head_rotation({0.5, 0, 0}) * Eigen::Vector3d::UnitZ();
  EXPECT_LT(gaze.z(), 0);  // towards the camera
  EXPECT_LT(gaze.x(), 0);
}

/// A ball that is no head, as a depth map.
DepthImage ball_image() {
  const Camera camera = head_camera();
  DepthImage depth(camera.width, camera.height, 0);
  for (int v = 140; v < 340; ++v)
    for (int u = 220; u < 420; ++u) {
      const double away = std::hypot(u - 320, v - 240) / 100;
      if (away < 1) depth(u, v) = static_cast<float>(800 - 130 * std::sqrt(1 - away * away));
    }
  return depth;
}

TEST(HeadForestTest, ThatOfPliantFindsHeadsThatItWasNotTrainedOn) {
  HeadViewOptions alone;
  alone.variety = 0;
  alone.company = 0;
  const HeadTrial trial =
      try_head_forest(own_head_forest(), {}, HeadViews(random_heads(1, 77, 0), alone), 24, 5);
  EXPECT_GE(trial.found, 22);
  EXPECT_LT(mean_and_most(trial.position).mean, 10);
  EXPECT_LT(mean_and_most(trial.rotation).mean, 10);
}

TEST(HeadForestTest, NothingIsFoundInNothingAndInABall) {
  const Camera camera = head_camera();
  EXPECT_FALSE(find_head(own_head_forest(), DepthImage(camera.width, camera.height, 0), camera, {}));
  EXPECT_FALSE(find_head(own_head_forest(), ball_image(), camera, {}));
}

SurfaceMap surface_of(const HeadView& view) {
  const Camera camera = head_camera();
  SurfaceImage image;
  image.points = Image<Eigen::Vector3f>(camera.width, camera.height, Eigen::Vector3f::Zero());
  image.normals = image.points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      if (is_depth(view.depth(u, v)))
        image.points(u, v) = camera.unproject(u, v, view.depth(u, v)).cast<float>();
  return SurfaceMap(camera, image);
}

TEST(HeadRelocalizerTest, TheModelGoesWithTheHead) {
  HeadViewOptions options;
  options.variety = 0;
  options.company = 0;
  options.greatest_angles = {25, 15, 10};
  options.nearest = 600;
  options.farthest = 900;
  const HeadViews views(random_heads(1, 78, 0), options);
  HeadRelocalizer relocalizer(std::make_shared<const HeadForest>(own_head_forest()), {}, 1);
  Eigen::Isometry3d head_from_model = moved({30, -200, 900}, {0.3, 2, -0.4});
  Draw draw(9, 0);
  const HeadView first = views.draw(draw);
  EXPECT_THAT(relocalizer.candidates({}, surface_of(first)), ::testing::IsEmpty());
  for (int i = 0; i < 5; ++i) {
    const HeadView view = views.draw(draw);
    relocalizer.remember({}, surface_of(view), view.camera_from_head * head_from_model);
  }
  const HeadView later = views.draw(draw);
  const auto candidates = relocalizer.candidates({}, surface_of(later));
  ASSERT_EQ(candidates.size(), 1U);
  const Eigen::Isometry3d error = (later.camera_from_head * head_from_model).inverse() * candidates.front();
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.3);
  EXPECT_LT((head_from_model * error * head_from_model.inverse()).translation().norm(), 30);
}

TEST(HeadRelocalizerTest, OneMotionThatIsFarFromTheOthersPlaysNoPart) {
  const Eigen::Isometry3d far = moved({500, 0, 0}, {0, 1, 0});
  const Eigen::Isometry3d mean =
      agreed_motion({moved({1, 0, 0}, {0.02, 0, 0}), far, moved({-1, 0, 0}, {-0.02, 0, 0})});
  EXPECT_TRUE(mean.isApprox(Eigen::Isometry3d::Identity(), 1e-9));
}

}  // namespace
}  // namespace pliant
