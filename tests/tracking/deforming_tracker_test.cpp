#include <gmock/gmock.h>

#include <algorithm>

#include "experiments/datasets/frame_source.h"
#include "experiments/tasks/point_truth.h"
#include "framework/tracking/tracker.h"
#include "tests/experiments/experiment_files.h"

// A head that turns a little and then inflates its cheeks, tracked as a model that may deform.
namespace pliant::test {
namespace {

using ::testing::HasSubstr;

const std::string kAdaptive = "policy={type: adaptive, threshold: 0.3, patience: 0}";
const std::vector<std::string> kUpdates{"update={type: reintegration, weight: 64}",
                                        "update={type: warp_field}"};

class DeformingTracker : public ExperimentFiles {
 protected:
  static constexpr int begins = 6;  ///< the last frame of the face at rest

  DeformingTracker() : stream_(registry_.make<FrameSource>(values({}).section("data"))->open(device_, 1)) {
    while (auto frame = stream_->next()) seen_.push_back(*std::move(frame));
  }

  Parameters values(const std::vector<std::string>& more) const {
    std::vector<std::string> sets{
        "data={type: head, image_width: 160, image_height: 120, focal_length: 131.25, distance: 500, keys: "
        "{a: {at: 0}, rest: {at: 0.167, motion: {rotation_y: 5}}, held: {at: 0.4, pose: [cheeks=1], motion: "
        "{rotation_y: 2}}, end: {at: 0.5, pose: [cheeks=1]}}}",
        "model={type: tsdf, volume: fitted, resolution: 96}", "acquisition={filter: none}",
        "followed={from: 6, step: 2}", "stopping={max_iterations: 6}"};
    sets.insert(sets.end(), more.begin(), more.end());
    return plan("", sets).runs.at(0).values;
  }

  struct Tracked {
    std::vector<FrameRecord> records;
    std::vector<Eigen::Vector3f> followed;  ///< at the end, mm, model's frame
    Mesh mesh;                              ///< likewise
    FollowedErrors errors;                  ///< likewise
  };

  Tracked track(const std::vector<std::string>& sets) {
    const TrackingMethod method = make_tracking_method(values(sets), registry_);
    Tracker tracker(method, stream_->rig(), device_);
    Tracked tracked;
    for (const Frame& frame : seen_) tracked.records.push_back(tracker.track(frame));
    tracked.followed = unflatten(tracker.model().followed());
    tracked.mesh = tracker.model().mesh();
    tracked.errors = *PointTruth(*stream_, 1, tracker.followed_pixels())
                          .error_of(tracked.followed, tracked.records.back().camera_from_model,
                                    static_cast<int>(seen_.size()));
    return tracked;
  }

  Device device_;
  std::unique_ptr<DataStream> stream_;
  std::vector<Frame> seen_;
};

void expect_same_poses(const std::vector<FrameRecord>& a, const std::vector<FrameRecord>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_EQ(a[i].camera_from_model.matrix(), b[i].camera_from_model.matrix()) << "frame " << i + 1;
}

TEST_F(DeformingTracker, RegistersTheModelWhileTheFaceDeforms) {
  for (const std::string& update : kUpdates) {
    SCOPED_TRACE(update);
    int registered = 0;
    for (const FrameRecord& record : track({kAdaptive, update}).records) {
      EXPECT_EQ(record.state, record.number > 1 ? FrameState::tracked : FrameState::started) << record.reason;
      EXPECT_LE(record.error.mean, record.rigid_error.mean);
      EXPECT_EQ(record.registration.has_value(), is_registered(record) || is_rejected(record));
      if (!is_registered(record)) continue;
      registered += record.number > begins ? 1 : 0;
      EXPECT_LE(record.error.mean, 0.95 * record.rigid_error.mean) << "min_gain";
      EXPECT_GT(record.registration->nodes, 10);
      EXPECT_GT(record.registration->constraints, 100);
      EXPECT_GT(record.registration->iterations, 0);
      EXPECT_FALSE(record.registration->reason.empty());
    }
    EXPECT_GE(registered, 2);
  }
}

// Points slide along the surface where each is drawn to the point at its pixel: the plane there is told more
// of.
TEST_F(DeformingTracker, FollowedPointsGoWithTheFace) {
  const Tracked rigid = track({"policy=rigid_only"});
  ASSERT_GT(rigid.errors.moving.count, 50);
  const Tracked tracked = track(
      {kAdaptive, "update=warp_field", "energies={point_to_plane: {weight: 100}, constraint: {weight: 5}}"});
  EXPECT_LT(tracked.errors.moving.mean, 0.9 * rigid.errors.moving.mean);
  EXPECT_LT(tracked.errors.visible.mean, rigid.errors.visible.mean);
}

TEST_F(DeformingTracker, TheSameFramesGiveTheSameBits) {
  for (const std::string& update : kUpdates) {
    SCOPED_TRACE(update);
    const Tracked once = track({kAdaptive, update});
    const Tracked again = track({kAdaptive, update});
    expect_same_poses(once.records, again.records);
    EXPECT_EQ(once.followed, again.followed);
    EXPECT_EQ(once.mesh.vertices, again.mesh.vertices);
    for (std::size_t i = 0; i < once.records.size(); ++i)
      EXPECT_EQ(once.records[i].error.mean, again.records[i].error.mean);
  }
}

TEST_F(DeformingTracker, RejectedRegistrationsLeaveTheModelAsItWas) {
  const Tracked rigid = track({"policy=rigid_only"});
  const Tracked rejected = track({kAdaptive, "tracking_error={min_gain: 0.99}"});
  int rejections = 0;
  for (const FrameRecord& record : rejected.records) {
    EXPECT_FALSE(is_registered(record));
    if (!record.registration) continue;
    ++rejections;
    EXPECT_TRUE(is_rejected(record));
    EXPECT_FALSE(record.registration->reason.empty());
    EXPECT_EQ(record.error.mean, record.rigid_error.mean);
  }
  EXPECT_GE(rejections, 2);
  expect_same_poses(rejected.records, rigid.records);
  EXPECT_EQ(rejected.mesh.vertices, rigid.mesh.vertices);
  EXPECT_EQ(rejected.followed, rigid.followed);
}

TEST_F(DeformingTracker, WithNothingToCompareEveryRegistrationIsRejected) {
  int rejections = 0;
  for (const FrameRecord& record :
       track({"policy={type: every_n, n: 2}", "tracking_error={max_distance: 1e-9}"}).records) {
    EXPECT_EQ(record.error.matched, 0);
    EXPECT_FALSE(is_registered(record));
    rejections += is_rejected(record) ? 1 : 0;
  }
  EXPECT_GE(rejections, 2);
}

TEST_F(DeformingTracker, RigidOnlyTracksAsIfThereWereNoPolicy) {
  const Tracked rigid = track({"policy=rigid_only"});
  const Tracked plain = track({});
  expect_same_poses(rigid.records, plain.records);
  EXPECT_EQ(rigid.mesh.vertices, plain.mesh.vertices);
  for (std::size_t i = 1; i < plain.records.size(); ++i) {
    EXPECT_GT(rigid.records[i].rigid_error.matched, 1000) << "it is measured";
    EXPECT_EQ(plain.records[i].rigid_error.matched, 0);
    EXPECT_FALSE(rigid.records[i].registration);
  }
}

}  // namespace
}  // namespace pliant::test
