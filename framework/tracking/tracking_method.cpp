#include "framework/tracking/tracking_method.h"

namespace pliant {
namespace {

ParameterTable followed_table() {
  const FollowedPoints defaults;
  return {integer("from", defaults.from)
              .range(0, 1e9)
              .doc("Number of the frame after which they are chosen; 0: none is followed"),
          integer("step", defaults.step)
              .unit("pixel")
              .range(1, 64)
              .doc("Between them, in the view of the frame that began the model")};
}

FollowedPoints make_followed(const Parameters& section) {
  return {static_cast<int>(section.integer("from")), static_cast<int>(section.integer("step"))};
}

}  // namespace

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
      component("policy", Policy::kind)
          .optional()
          .doc("When the model is registered non-rigidly to such a frame [4.8]; without it the model is "
               "rigid, "
               "and its distance to frames is not measured"),
      component("update", ModelUpdate::kind, "warp_field").doc("How it takes up what comes of that [4.8]"),
      group("tracking_error", tracking_error_table())
          .doc("How the distance between the model and a frame is measured, by which the policy judges"),
      group("followed", followed_table()).doc("Points of the model that are followed wherever it goes"),
  };
}

TrackingMethod make_tracking_method(const Parameters& experiment, const Registry& registry) {
  const bool deforms = experiment.has("policy");
  return {make_acquisition(experiment.section("acquisition"), registry),
          registry.make<Segmentation>(experiment.section("segmentation")),
          registry.make<PoseEstimatorKind>(experiment.section("pose")),
          registry.make<ModelKind>(experiment.section("model")),
          registry.make<RelocalizerKind>(experiment.section("relocalizer")),
          deforms ? registry.make<Policy>(experiment.section("policy")) : nullptr,
          deforms ? make_nonrigid_method(experiment, registry) : NonRigidMethod(),
          registry.make<ModelUpdate>(experiment.section("update")),
          read_tracking_error(experiment.section("tracking_error")),
          make_followed(experiment.section("followed"))};
}

}  // namespace pliant
