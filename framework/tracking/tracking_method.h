#pragma once

#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/imaging/preprocessor.h"
#include "framework/imaging/segmentation.h"
#include "framework/model/deforming_model.h"
#include "framework/model/reference_model.h"
#include "framework/pose/pose_estimator.h"
#include "framework/pose/relocalizer.h"
#include "framework/registration/nonrigid_method.h"
#include "framework/tracking/policy.h"
#include "framework/tracking/tracking_error.h"

namespace pliant {

/// Which points of the model are followed wherever its surface goes.
struct FollowedPoints {
  int from = 0;  ///< number of the frame after which they are chosen; 0: none is
  int step = 2;  ///< pixels between them, in u and v, in the view of the frame that began the model
};

/// How the frames of a stream are tracked [thesis chapter 3].
struct TrackingMethod {
  Acquisition acquisition;
  std::unique_ptr<Segmentation> segmentation;
  std::unique_ptr<PoseEstimatorKind> pose;
  std::unique_ptr<ModelKind> model;
  std::unique_ptr<RelocalizerKind> relocalizer;
  std::unique_ptr<Policy>
      policy;                  ///< null: the model is rigid, and its distance to the frames is not measured
  NonRigidMethod deformation;  ///< how the model is registered to frames when the policy wants it
  std::unique_ptr<ModelUpdate> update;
  TrackingErrorOptions error;
  FollowedPoints followed;
};

/// The rows of an experiment file that describe it; with a `policy` those of nonrigid_rows() do, too. An
/// experiment tracks where it has a `model`.
std::vector<Parameter> tracking_rows();

/// Assembles what an experiment with a model describes.
TrackingMethod make_tracking_method(const Parameters& experiment, const Registry& registry);

}  // namespace pliant
