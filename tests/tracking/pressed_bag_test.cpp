#include <gtest/gtest.h>

#include "experiments/datasets/frame_source.h"
#include "experiments/tasks/point_truth.h"
#include "framework/tracking/tracker.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

constexpr const char* kPressedBag = R"(
extends: methods/tracking.yaml
data:
  type: bag
  image_width: 160
  image_height: 120
  focal_length: 131.25
  distance: 700
  keys: {rest: {at: 0}, held: {at: 0.6, pose: [pressed=0.7, folded=0.25]}}
model: {type: tsdf, volume: fitted, resolution: 96}
acquisition: {filter: none}
followed: {from: 1, step: 2}
policy: {type: every_n, n: 1}
update: warp_field
)";

class PressedBag : public ExperimentFiles {
 protected:
  Parameters values() const {
    return plan_experiment({write("bag.yaml", kPressedBag), {}, {}, {PLIANT_EXPERIMENTS}}, registry_)
        .runs.at(0)
        .values;
  }
};

// Regularization asks affine forms to turn inside out across a bulge that is pressed in; where rotation
// weighs less beside it than methods/tracking.yaml has it they do, and the model is torn.
TEST_F(PressedBag, IsFollowedByAWarpField) {
  Device device;
  const Parameters experiment = values();
  const auto stream = registry_.make<FrameSource>(experiment.section("data"))->open(device, 1);
  const TrackingMethod method = make_tracking_method(experiment, registry_);
  Tracker tracker(method, stream->rig(), device);
  FrameRecord last;
  while (const auto frame = stream->next()) {
    last = tracker.track(*frame);
    EXPECT_FALSE(is_rejected(last)) << "frame " << last.number << ": " << last.registration->reason;
  }
  const FollowedErrors errors =
      *PointTruth(*stream, 1, tracker.followed_pixels())
           .error_of(unflatten(tracker.model().followed()), last.camera_from_model, last.number);
  EXPECT_EQ(last.number, 19);
  EXPECT_LT(last.error.mean, 0.4);
  EXPECT_GT(last.error.matched, 2900);
  EXPECT_LT(errors.visible.mean, 15) << "where it is pressed in by 75 mm";
}

}  // namespace
}  // namespace pliant::test
