#pragma once

#include <Eigen/Geometry>

#include "framework/device/device.h"
#include "framework/model/deforming_model.h"
#include "framework/registration/nonrigid.h"
#include "framework/tracking/frame_record.h"
#include "framework/tracking/tracking_error.h"

namespace pliant {

/// Registers a deforming model non-rigidly to frames [thesis 4.8].
class ModelRegistration {
 public:
  /// Both must outlive this. `min_gain`: share by which the error must fall for what comes out to be kept.
  ModelRegistration(Device& device, const NonRigidMethod& method, double min_gain)
      : device_(device), method_(method), min_gain_(min_gain) {}

  /// Deforms the model to what a frame shows, `seen`; `view`: the last one of the model, from there. What
  /// comes out is rejected, and the model stays as it was, when it is not finite, gains too little, loses
  /// matches, or folds the surface. Writes `registration` of the record, and `error` where it is kept. Gives
  /// where the model is after it: what most of the surface does alike is motion, the rest deformation.
  Eigen::Isometry3d run(DeformingModel& model, const SurfaceMap& view, const SurfaceMap& seen,
                        const Eigen::Isometry3d& camera_from_model, TrackingErrorMeter& meter,
                        FrameRecord& record) const;

 private:
  Device& device_;
  const NonRigidMethod& method_;
  double min_gain_;
};

/// The rigid motion (mm) that most nodes of a graph have in common, of where `affine` (affine_size numbers
/// each) moves them: a least-squares fit from which those that deform are left out little by little, by
/// graduated non-convexity [Blake and Zisserman 1987]. The least absolute distance would not do: where all
/// that deforms lies to one side, as a jaw does, that tilts.
Eigen::Isometry3d common_motion(const EmbeddedGraph& graph, const Array<float>& affine);

}  // namespace pliant
