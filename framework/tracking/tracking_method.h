#pragma once

#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/imaging/preprocessor.h"
#include "framework/imaging/segmentation.h"
#include "framework/model/reference_model.h"
#include "framework/pose/pose_estimator.h"
#include "framework/pose/relocalizer.h"

namespace pliant {

/// How the frames of a stream are tracked [thesis chapter 3].
struct TrackingMethod {
  Acquisition acquisition;
  std::unique_ptr<Segmentation> segmentation;
  std::unique_ptr<PoseEstimatorKind> pose;
  std::unique_ptr<ModelKind> model;
  std::unique_ptr<RelocalizerKind> relocalizer;
};

/// The rows of an experiment file that describe it. An experiment tracks where it has a `model`.
std::vector<Parameter> tracking_rows();

/// Assembles what an experiment with a model describes.
TrackingMethod make_tracking_method(const Parameters& experiment, const Registry& registry);

}  // namespace pliant
