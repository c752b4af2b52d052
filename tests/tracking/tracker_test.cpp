#include "framework/tracking/tracker.h"

#include <gmock/gmock.h>

#include "experiments/datasets/frame_source.h"
#include "experiments/tasks/track_truth.h"
#include "framework/core/error.h"
#include "tests/device/host_bytes.h"
#include "tests/experiments/experiment_files.h"

// A camera that goes a little around a head, frame by frame.
namespace pliant::test {
namespace {

using ::testing::HasSubstr;

class TrackerTest : public ExperimentFiles {
 protected:
  static constexpr int frames = 12;

  explicit TrackerTest(const std::string& more_data = "frames: " + std::to_string(frames) +
                                                      ", keys: {a: {at: 0}, b: {at: 0.36667, camera: "
                                                      "{look_from: [60, -20, 10]}}}")
      : values_(plan("", {"data={type: head, image_width: 160, image_height: 120, focal_length: 131.25, " +
                              more_data + "}",
                          "model={type: tsdf, volume: fitted, resolution: 96}", "acquisition={filter: none}"})
                    .runs.at(0)
                    .values),
        method_(make_tracking_method(values_, registry_)),
        stream_(registry_.make<FrameSource>(values_.section("data"))->open(device_, 1)) {
    while (auto frame = stream_->next()) seen_.push_back(*std::move(frame));
  }

  /// The records of frames that are tracked one after the other.
  std::vector<FrameRecord> track(const std::vector<Frame>& frames_to_track) {
    Tracker tracker(method_, stream_->rig(), device_);
    std::vector<FrameRecord> records;
    for (const Frame& frame : frames_to_track) records.push_back(tracker.track(frame));
    return records;
  }

  /// Of frame `number` as it was made, the first is 1, against the first.
  PoseError error_of(const FrameRecord& record, int number) const {
    return pose_error(record.camera_from_model,
                      stream_->camera_pose(number)->inverse() * *stream_->camera_pose(1));
  }

  Frame without_depth() const {
    Frame frame = seen_.front();
    frame.depth = DepthImage(frame.depth.width(), frame.depth.height(), 0);
    return frame;
  }

  Device device_;
  Parameters values_;
  TrackingMethod method_;
  std::unique_ptr<DataStream> stream_;
  std::vector<Frame> seen_;
};

TEST_F(TrackerTest, FindsTheCameraOfEveryFrame) {
  const auto records = track(seen_);
  ASSERT_EQ(records.size(), static_cast<std::size_t>(frames));
  EXPECT_EQ(records[0].state, FrameState::started);
  const double way = stream_->camera_pose(frames)->translation().norm();
  ASSERT_GT(way, 60);
  for (int number = 2; number <= frames; ++number) {
    const FrameRecord& record = records[static_cast<std::size_t>(number - 1)];
    EXPECT_EQ(record.number, number);
    EXPECT_EQ(record.state, FrameState::tracked) << record.reason;
    EXPECT_LT(error_of(record, number).translation, 2) << number;
    EXPECT_LT(error_of(record, number).rotation, 0.5) << number;
  }
}

TEST_F(TrackerTest, TheSameFramesGiveTheSameBits) {
  const auto once = track(seen_);
  const auto again = track(seen_);
  for (std::size_t i = 0; i < once.size(); ++i)
    EXPECT_EQ(once[i].camera_from_model.matrix(), again[i].camera_from_model.matrix()) << i;
}

TEST_F(TrackerTest, AFrameWithoutDepthIsLostAndTheNextFoundFromThePoseBefore) {
  const auto records = track({seen_[0], seen_[1], without_depth(), without_depth(), seen_[2]});
  for (const int lost : {2, 3}) {
    const auto& record = records[static_cast<std::size_t>(lost)];
    EXPECT_EQ(record.state, FrameState::lost);
    EXPECT_FALSE(record.reason.empty());
    EXPECT_EQ(record.camera_from_model.matrix(), records[1].camera_from_model.matrix());
  }
  EXPECT_EQ(records[4].state, FrameState::tracked) << records[4].reason;
  EXPECT_LT(error_of(records[4], 3).translation, 2);
}

TEST_F(TrackerTest, WaitsForAFrameThatShowsSomething) {
  const auto records = track({without_depth(), without_depth(), seen_[0], seen_[1]});
  for (const int waiting : {0, 1}) {
    EXPECT_EQ(records[static_cast<std::size_t>(waiting)].state, FrameState::waiting);
    EXPECT_THAT(records[static_cast<std::size_t>(waiting)].reason, HasSubstr("no depth"));
  }
  EXPECT_EQ(records[2].state, FrameState::started);
  EXPECT_EQ(records[3].state, FrameState::tracked) << records[3].reason;
}

TEST_F(TrackerTest, WhatIsBeyondTheDepthCutIsNotThere) {
  method_.acquisition.depth_cut = 100;  // before the head begins
  for (const FrameRecord& record : track({seen_[0], seen_[1]})) EXPECT_EQ(record.state, FrameState::waiting);
}

TEST_F(TrackerTest, AFrameOfAnotherSizeIsRefusedAndHarmsNothing) {
  Tracker tracker(method_, stream_->rig(), device_);
  tracker.track(seen_[0]);
  Frame small = seen_[1];
  small.depth = DepthImage(80, 60, 500);
  EXPECT_THAT(data_error_of([&] { tracker.track(small); }),
              HasSubstr("frame 2: the depth image is 80 x 60 pixels; expected the camera's 160 x 120"));
  EXPECT_EQ(tracker.track(seen_[1]).state, FrameState::tracked);
}

TEST_F(TrackerTest, ALeapIsLostAndTheModelStaysAsItWas) {
  Tracker tracker(method_, stream_->rig(), device_);
  for (const Frame& frame : seen_) tracker.track(frame);
  const std::size_t vertices = tracker.model().mesh().vertices.size();
  Frame leap = seen_.front();
  leap.depth = DepthImage(160, 120, 0);
  for (int v = 10; v < 40; ++v)
    for (int u = 5; u < 30; ++u) leap.depth(u, v) = 900;  // a wall that stands where the head is not
  const FrameRecord record = tracker.track(leap);
  EXPECT_EQ(record.state, FrameState::lost);
  EXPECT_THAT(record.reason, HasSubstr("meet a point of the frame"));
  EXPECT_EQ(tracker.model().mesh().vertices.size(), vertices);
}

TEST_F(TrackerTest, AllocatesNothingAfterTheThirdFrameAndNothingGrows) {
  Tracker tracker(method_, stream_->rig(), device_);
  std::uint64_t allocations = 0;
  std::size_t bytes = 0;
  for (int i = 0; i < 300; ++i) {
    // To and fro, so that each is near the one before.
    const int place = i % (2 * frames - 2);
    tracker.track(seen_[static_cast<std::size_t>(place < frames ? place : 2 * frames - 2 - place)]);
    if (i == 2) allocations = device_.counts().allocations;
    if (i == 50) bytes = test::host_bytes();
  }
  EXPECT_EQ(device_.counts().allocations, allocations);
  EXPECT_LT(test::host_bytes(), bytes + 25000) << "a hundred bytes a frame would be as much";
}

TEST_F(TrackerTest, TenThousandFramesTakeNoMoreMemoryThanAHundred) {
  const Camera small{40, 40, 15.5, 11.5, 32, 24};
  Tracker tracker(method_, Rig{small}, device_);
  std::uint64_t allocations = 0;
  std::size_t bytes = 0;
  int lost = 0;
  for (int i = 0; i < 10000; ++i) {
    Frame frame;
    frame.time = i;
    frame.depth = DepthImage(small.width, small.height, 0);
    for (int v = 0; v < small.height; ++v)
      for (int u = 0; u < small.width; ++u)
        frame.depth(u, v) = 500 + static_cast<float>((u - 16) * (u - 16) + 2 * (v - 12) * (v - 12)) / 8 +
                            static_cast<float>(i % 20 < 10 ? i % 10 : 10 - i % 10);
    lost += tracker.track(frame).state == FrameState::lost ? 1 : 0;
    if (i == 100) {
      allocations = device_.counts().allocations;
      bytes = test::host_bytes();
    }
  }
  EXPECT_EQ(lost, 0);
  EXPECT_EQ(device_.counts().allocations, allocations);
  EXPECT_LT(test::host_bytes(), bytes + (1 << 20)) << "a hundred bytes a frame would be as much";
}

/// The camera goes farther around the head.
class TrackerFocalLength : public TrackerTest {
 protected:
  TrackerFocalLength()
      : TrackerTest(
            "distance: 700, frames: 31, keys: {a: {at: 0}, b: {at: 1, "
            "camera: {look_from: [-220, 60, 40]}}}") {}

  FocalLengthEstimate estimate_with(double factor) {
    Rig rig = stream_->rig();
    rig.color.reset();
    rig.depth.fx *= factor;
    rig.depth.fy *= factor;
    Tracker tracker(method_, rig, device_);
    for (Frame& frame : seen_) {
      frame.color = {};
      EXPECT_NE(tracker.track(frame).state, FrameState::lost) << factor;
    }
    return tracker.focal_length();
  }
};

/// Might register any frame.
class Deforming : public Policy {
 public:
  bool registers(const PolicyInput& /*input*/) const override { return false; }
};

TEST_F(TrackerFocalLength, IsNotToldByWhatMayDeform) {
  method_.policy = std::make_unique<Deforming>();
  EXPECT_EQ(estimate_with(0.85).views, 0);
}

TEST_F(TrackerFocalLength, IsToldWhereItIsWrong) {
  const FocalLengthEstimate right = estimate_with(1);
  EXPECT_FALSE(right.is_wrong()) << right.change << " +- " << right.error;
  EXPECT_NEAR(right.change, 0, 0.03);
  for (const double factor : {0.85, 1.15}) {
    const FocalLengthEstimate wrong = estimate_with(factor);
    EXPECT_TRUE(wrong.is_wrong()) << factor << ": " << wrong.change << " +- " << wrong.error;
    EXPECT_NEAR(wrong.change, 1 / factor - 1, 0.06) << factor;
  }
}

}  // namespace
}  // namespace pliant::test
