#include "framework/tracking/tracking_method.h"

namespace pliant {

std::vector<Parameter> tracking_rows() {
  return {
      component("model", ModelKind::kind)
          .optional()
          .doc("Tracks all frames, fused into such a reference model, instead of registering two [3.2]"),
      group("acquisition", ParameterTable(acquisition_rows()))
          .doc("How depth becomes a surface before it is tracked [3.1]"),
      component("segmentation", Segmentation::kind, "none").doc("What of the frames is tracked [3.1]"),
      component("pose", PoseEstimatorKind::kind, "icp_projective")
          .doc("How the model is found again in each frame that is tracked [3.3]"),
      component("relocalizer", RelocalizerKind::kind, "none")
          .doc("How it is found again where it moved further than that reaches [3.3]"),
  };
}

TrackingMethod make_tracking_method(const Parameters& experiment, const Registry& registry) {
  return {make_acquisition(experiment.section("acquisition"), registry),
          registry.make<Segmentation>(experiment.section("segmentation")),
          registry.make<PoseEstimatorKind>(experiment.section("pose")),
          registry.make<ModelKind>(experiment.section("model")),
          registry.make<RelocalizerKind>(experiment.section("relocalizer"))};
}

}  // namespace pliant
