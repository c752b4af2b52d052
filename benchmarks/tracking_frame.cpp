#include "benchmarks/tracking_frame.h"

#include <memory>
#include <utility>

#include "benchmarks/tracking_pose.h"
#include "experiments/runner/components.h"
#include "framework/config/config.h"
#include "framework/tracking/tracker.h"

namespace pliant::bench {
namespace {

bool is_whole(const TrackedImages& images) { return images.region == whole_image(images.rig.depth); }

/// As a file would say it.
TrackingMethod method_for(const TrackedImages& images) {
  Registry registry;
  register_everything(registry);
  const ConfigText text{is_whole(images)
                            ? "model: tsdf"
                            : "model: {type: tsdf, volume: fitted}\nacquisition: {depth_cut: 1300}\n"
                              "segmentation: bounding_box",
                        "tracking",
                        {}};
  return make_tracking_method(
      load_experiment({text, {}, {}}, ParameterTable(tracking_rows()), registry).values, registry);
}

struct Maps {
  Maps(Device& device, const TrackedImages& images)
      : method(method_for(images)),
        before(device, images.rig, method.acquisition, images.region),
        after(device, images.rig, method.acquisition, images.region) {
    before.process(images.before);
    after.process(images.after);
  }

  TrackingMethod method;
  Preprocessor before;
  Preprocessor after;
};

struct Tracked {
  Tracked(Device& device, const TrackedImages& seen)
      : images(seen), method(method_for(seen)), tracker(method, seen.rig, device) {
    tracker.track(images.before);
  }

  void track() {
    is_after = !is_after;
    tracker.track(is_after ? images.after : images.before);
  }

  const TrackedImages& images;
  TrackingMethod method;
  Tracker tracker;
  bool is_after = false;
};

}  // namespace

StagePair icp_stage(Device& device, const TrackedImages& images) {
  const auto maps = std::make_shared<Maps>(device, images);
  StagePair stage = pose_stage(device, images, maps->before.surface(), maps->after.surface());
  stage.ours = [maps, ours = std::move(stage.ours)] { ours(); };
  return stage;
}

StagePair whole_frame(Device& device, const TrackedImages& images, std::function<void()> opencv) {
  const auto tracked = std::make_shared<Tracked>(device, images);
  return {"frame", [tracked] { tracked->track(); }, std::move(opencv)};
}

}  // namespace pliant::bench
