#include "framework/tracking/tracking_method.h"

namespace pliant {

std::vector<Parameter> tracking_rows() {
  return {
      component("model", ModelKind::kind)
          .optional()
          .doc("Tracks all frames, fused into such a reference model, instead of registering two [3.2]"),
      real("depth_cut")
          .optional()
          .unit("mm")
          .above(0)
          .doc("of frames that are tracked: what is further away is background [3.1]"),
      component("segmentation", Segmentation::kind, "none").doc("What of the frames is tracked [3.1]"),
      component("normals", Normals::kind, "integral_images").doc("of frames that are tracked [3.1]"),
      component("pose", PoseEstimatorKind::kind, "icp_projective")
          .doc("How the model is found again in each frame [3.3]"),
  };
}

TrackingMethod make_tracking_method(const Parameters& experiment, const Registry& registry) {
  return {experiment.has("depth_cut") ? experiment.real("depth_cut") : 0,
          registry.make<Segmentation>(experiment.section("segmentation")),
          registry.make<DepthFilter>(experiment.section("filter")),
          registry.make<Normals>(experiment.section("normals")),
          registry.make<PoseEstimatorKind>(experiment.section("pose")),
          registry.make<ModelKind>(experiment.section("model"))};
}

}  // namespace pliant
