// What a tracker finds of an object that moves and deforms, judged by the truth.
#include "experiments/tasks/track_truth.h"

#include <gtest/gtest.h>

#include <limits>

#include "experiments/tasks/point_truth.h"
#include "tests/datasets/data_of.h"

namespace pliant::test {
namespace {

/// A head that opens its mouth while it moves before a still camera; 7 frames, at rest at both ends.
class TrackTruthTest : public ::testing::Test {
 protected:
  static constexpr int open = 4;  // the frame in which the mouth is
  static constexpr int last = 7;

  TrackTruthTest()
      : stream_(
            data_of("{type: head, image_width: 96, image_height: 72, focal_length: 90, distance: 600, keys: {"
                    "a: {at: 0, motion: {rotation_y: 3}}, "
                    "b: {at: 0.1, pose: [open_mouth=1], motion: {rotation_y: -9, shift_x: 15}}, "
                    "c: {at: 0.2, motion: {shift_z: 20}}}}")
                ->open(shared_device(), 1)) {
    const DepthImage depth = stream_->next()->depth;
    for (int v = 0; v < depth.height(); ++v)
      for (int u = 0; u < depth.width(); ++u)
        if (depth(u, v) > 0) pixels_.emplace_back(u, v);
  }

  /// What a tracker without any error would tell.
  FrameRecord record_of(int number) const {
    FrameRecord record;
    record.number = number;
    record.state = number == 1 ? FrameState::started : FrameState::tracked;
    record.camera_from_model = stream_->camera_pose(number)->inverse() * *stream_->camera_pose(1);
    return record;
  }

  /// The true surface of a frame in the model's frame.
  Mesh model_of(int number) const {
    Mesh mesh = *stream_->surface(number);
    const Eigen::Isometry3f model_from_camera = record_of(number).camera_from_model.inverse().cast<float>();
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex = model_from_camera * vertex;
    return mesh;
  }

  /// The true points of the first frame's pixels in the model's frame, in frame `number`.
  std::vector<Eigen::Vector3f> points_of(int number) const {
    std::vector<Eigen::Vector3f> points = stream_->points_of(1, pixels_, number)->positions;
    const Eigen::Isometry3f model_from_camera = record_of(number).camera_from_model.inverse().cast<float>();
    for (Eigen::Vector3f& point : points) point = model_from_camera * point;
    return points;
  }

  std::unique_ptr<DataStream> stream_;
  std::vector<Eigen::Vector2i> pixels_;
};

TEST_F(TrackTruthTest, KnowsThePoseOfAnObjectThatMoves) {
  TrackTruth truth(*stream_);
  truth.error_of(record_of(1));
  for (int number = 2; number <= last; ++number) {
    FrameRecord record = record_of(number);
    EXPECT_LT(truth.error_of(record)->translation, 1e-6);
    EXPECT_LT(truth.error_of(record)->rotation, 1e-4);
    record.camera_from_model.translation().x() += 3;
    EXPECT_NEAR(truth.error_of(record)->translation, 3, 1e-6);
  }
  EXPECT_GT((record_of(open).camera_from_model.translation()).norm(), 50) << "it does move";
}

TEST_F(TrackTruthTest, JudgesAModelByTheFrameItIsOf) {
  TrackTruth truth(*stream_);
  EXPECT_FALSE(truth.error_of(model_of(1), 1)) << "no frame has begun it";
  truth.error_of(record_of(1));
  EXPECT_LT(truth.error_of(model_of(open), open)->mean, 0.01);
  EXPECT_GT(truth.error_of(model_of(open), 1)->p95, 1);
  EXPECT_GT(truth.error_of(model_of(1), open)->p95, 1);
  EXPECT_LT(truth.error_of(model_of(1), last)->mean, 0.01) << "neutral again";
  EXPECT_FALSE(truth.error_of(Mesh{}, open));
}

TEST_F(TrackTruthTest, PointsThatWentWithTheSurfaceAreRight) {
  const PointTruth truth(*stream_, 1, pixels_);
  for (const int number : {1, 2, open, last}) {
    const auto errors = truth.error_of(points_of(number), record_of(number).camera_from_model, number);
    ASSERT_TRUE(errors);
    EXPECT_EQ(errors->all.count, static_cast<int>(pixels_.size()));
    EXPECT_LT(errors->all.max, 0.01) << number;
  }
}

TEST_F(TrackTruthTest, PointsThatDeviateAreToldByHowFar) {
  const PointTruth truth(*stream_, 1, pixels_);
  std::vector<Eigen::Vector3f> points = points_of(open);
  for (Eigen::Vector3f& point : points) point.y() += 2;
  points.front().y() += 48;
  points.back().x() = std::numeric_limits<float>::quiet_NaN();
  const auto errors = truth.error_of(points, record_of(open).camera_from_model, open);
  const auto count = static_cast<double>(pixels_.size()) - 1;
  EXPECT_EQ(errors->all.count, count) << "all that are finite";
  EXPECT_NEAR(errors->all.mean, 2 + 48 / count, 0.01);
  EXPECT_NEAR(errors->all.p95, 2, 0.01);
  EXPECT_NEAR(errors->all.max, 50, 0.01);
  EXPECT_GT(errors->visible.count, count / 2);
  EXPECT_LT(errors->visible.count, count);
}

// Who keeps the neutral form is wrong where the jaw moved, though the rest is right.
TEST_F(TrackTruthTest, MovingPointsAreThoseThatDeform) {
  const PointTruth truth(*stream_, 1, pixels_);
  const auto errors = truth.error_of(points_of(1), record_of(open).camera_from_model, open);
  EXPECT_GT(errors->moving.count, 20);
  EXPECT_LT(errors->moving.count, errors->all.count / 2);
  EXPECT_GT(errors->moving.mean, 5);
  EXPECT_DOUBLE_EQ(errors->moving.max, errors->all.max);
  EXPECT_EQ(truth.error_of(points_of(last), record_of(last).camera_from_model, last)->moving.count, 0);
  EXPECT_EQ(truth.error_of(points_of(last), record_of(last).camera_from_model, last)->moving.mean, 0);
}

TEST_F(TrackTruthTest, ThereIsAPointForEachPixel) {
  const PointTruth truth(*stream_, 1, pixels_);
  EXPECT_THROW(truth.error_of({}, Eigen::Isometry3d::Identity(), open), std::invalid_argument);
}

}  // namespace
}  // namespace pliant::test
