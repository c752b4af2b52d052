#pragma once

#include <memory>
#include <vector>

#include "framework/core/registry.h"
#include "framework/imaging/depth_filter.h"
#include "framework/imaging/normals.h"
#include "framework/imaging/segmentation.h"
#include "framework/model/reference_model.h"
#include "framework/pose/pose_estimator.h"

namespace pliant {

/// How the frames of a stream are tracked [thesis chapter 3].
struct TrackingMethod {
  double depth_cut = 0;  ///< mm; what is further away is dropped; 0: nothing is
  std::unique_ptr<Segmentation> segmentation;
  std::unique_ptr<DepthFilter> filter;
  std::unique_ptr<Normals> normals;
  std::unique_ptr<PoseEstimatorKind> pose;
  std::unique_ptr<ModelKind> model;
};

/// The rows of an experiment file that describe it but `filter`, which is one of a method's. An experiment
/// tracks where it has a `model`.
std::vector<Parameter> tracking_rows();

/// Assembles what an experiment with a model describes.
TrackingMethod make_tracking_method(const Parameters& experiment, const Registry& registry);

}  // namespace pliant
