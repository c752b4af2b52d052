#include <gmock/gmock.h>

#include "experiments/datasets/frame_source.h"
#include "experiments/runner/components.h"
#include "framework/config/config.h"
#include "framework/core/angle.h"
#include "framework/tracking/tracker.h"

// A camera that goes a little around a head, which then is suddenly elsewhere.
namespace pliant {
namespace {

using ::testing::HasSubstr;

constexpr int smooth = 10;  // frames before the leap
const Eigen::Vector3d middle(0, 0, 700);

class RelocalisationTest : public ::testing::Test {
 protected:
  RelocalisationTest() {
    register_everything(registry_);
    set_up("{type: features}");
    const auto stream = registry_.make<FrameSource>(values_->section("data"))->open(device_, 1);
    rig_ = stream->rig();
    while (auto frame = stream->next()) seen_.push_back(*std::move(frame));
    away_ = Eigen::Translation3d(middle + Eigen::Vector3d(90, -30, 20)) *
            Eigen::AngleAxisd(28 * degree, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(-middle);
  }

  void set_up(const std::string& relocalizer) {
    const std::string text =
        "data: {type: head, image_width: 320, image_height: 240, focal_length: 262.5, distance: 700, "
        "keys: {a: {at: 0}, b: {at: 0.15, camera: {look_from: [-60, 0, 0]}}, "
        "c: {at: 0.3, camera: {look_from: [-10, -20, 0]}}, "
        "d: {at: 0.33334, motion: {rotation_y: 28, shift_x: 90, shift_y: -30, shift_z: 20}}}}\n"
        "model: {type: tsdf, volume: fitted, resolution: 96}\nsegmentation: bounding_box\nrelocalizer: " +
        relocalizer;
    std::vector<Parameter> rows = tracking_rows();
    rows.push_back(component("data", FrameSource::kind));
    values_ =
        load_experiment({ConfigText{text, "the head", {}}, {}, {}}, ParameterTable(rows), registry_).values;
    method_ = make_tracking_method(*values_, registry_);
  }

  FrameRecord track(Tracker& tracker, Frame frame) {
    frame.time = time_++;
    return tracker.track(frame);
  }

  /// Of the frames before the leap, without colour if it is to be so.
  void track_all(Tracker& tracker, bool has_color = true) {
    for (int i = 0; i < smooth; ++i) {
      Frame frame = seen_[static_cast<std::size_t>(i)];
      if (!has_color) frame.color = {};
      EXPECT_NE(track(tracker, frame).state, FrameState::lost) << i;
    }
  }

  void expect_away(const FrameRecord& record) {
    EXPECT_EQ(record.state, FrameState::tracked) << record.reason;
    EXPECT_TRUE(record.relocalized);
    EXPECT_LT((record.camera_from_model * middle - away_ * middle).norm(), 5);
    EXPECT_LT(Eigen::AngleAxisd(record.camera_from_model.linear() * away_.linear().transpose()).angle(),
              2 * degree);
  }

  Frame leapt() const { return seen_.back(); }
  Frame without_depth() const {
    Frame frame = seen_.front();
    frame.depth = DepthImage(frame.depth.width(), frame.depth.height(), 0);
    return frame;
  }
  /// With a ball of 50 mm beside what is there.
  static Frame with_ball(Frame frame) {
    for (int v = 150; v < 190; ++v) {
      for (int u = 20; u < 60; ++u) {
        const double squared = (u - 40) * (u - 40) + (v - 170) * (v - 170);
        if (squared >= 380) continue;
        frame.depth(u, v) = 650 - static_cast<float>(2.5 * std::sqrt(400 - squared));
        frame.color(u, v) = {static_cast<std::uint8_t>(u * 37 % 256), static_cast<std::uint8_t>(v * 53 % 256),
                             90};
      }
    }
    return frame;
  }

  Device device_;
  Registry registry_;
  std::optional<Parameters> values_;
  TrackingMethod method_;
  Rig rig_;
  std::vector<Frame> seen_;
  Eigen::Isometry3d away_;  // the head after its leap, in the model's frame
  double time_ = 0;
};

TEST_F(RelocalisationTest, WhatLeftAndReturnsElsewhereIsFound) {
  Tracker tracker(method_, rig_, device_);
  track_all(tracker);
  for (int i = 0; i < 2; ++i) {
    const FrameRecord record = track(tracker, without_depth());
    EXPECT_EQ(record.state, FrameState::lost);
    EXPECT_FALSE(record.relocalized);
  }
  expect_away(track(tracker, leapt()));
  const FrameRecord next = track(tracker, leapt());
  EXPECT_EQ(next.state, FrameState::tracked) << next.reason;
  EXPECT_FALSE(next.relocalized) << "it is near to where it was";
  EXPECT_EQ(tracker.seen().window, tracker.model_view().window);
}

TEST_F(RelocalisationTest, WithoutARelocalizerTheRegionStaysAndItIsNotFound) {
  set_up("none");
  Tracker tracker(method_, rig_, device_);
  track_all(tracker);
  const PixelWindow region = tracker.seen().window;
  for (int i = 0; i < 2; ++i) {
    const FrameRecord record = track(tracker, leapt());
    EXPECT_FALSE(record.relocalized);
    EXPECT_GT((record.camera_from_model * middle - away_ * middle).norm(), 10);
    EXPECT_EQ(tracker.seen().window, region);
  }
}

TEST_F(RelocalisationTest, ItIsFoundWithoutColor) {
  Tracker tracker(method_, rig_, device_);
  track_all(tracker, false);
  Frame frame = leapt();
  frame.color = {};
  expect_away(track(tracker, frame));
}

TEST_F(RelocalisationTest, ItIsFoundBesideAnotherObject) {
  Tracker tracker(method_, rig_, device_);
  track_all(tracker);
  expect_away(track(tracker, with_ball(leapt())));
}

TEST_F(RelocalisationTest, AnotherObjectInItsPlaceIsNotTakenForIt) {
  Tracker tracker(method_, rig_, device_);
  track_all(tracker);
  const FrameRecord record = track(tracker, with_ball(without_depth()));
  EXPECT_EQ(record.state, FrameState::lost);
  EXPECT_FALSE(record.reason.empty());
  EXPECT_EQ(tracker.seen().window, tracker.model_view().window);
  expect_away(track(tracker, leapt()));
}

TEST_F(RelocalisationTest, TheRegionFollowsAndTakesNoNewMemory) {
  Tracker tracker(method_, rig_, device_);
  std::uint64_t allocations = 0;
  PixelWindow first;
  int moved = 0;
  for (int i = 0; i < 60; ++i) {
    const int place = i % (2 * smooth - 2);
    track(tracker, seen_[static_cast<std::size_t>(place < smooth ? place : 2 * smooth - 2 - place)]);
    if (i == 0) first = tracker.seen().window;
    if (i == 2 * smooth) allocations = device_.counts().allocations;
    if (!(tracker.seen().window == first)) ++moved;
  }
  EXPECT_GT(moved, 0);
  EXPECT_EQ(device_.counts().allocations, allocations);
}

}  // namespace
}  // namespace pliant
