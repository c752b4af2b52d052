#pragma once

#include <Eigen/Geometry>

#include "framework/device/device.h"
#include "framework/model/deforming_model.h"
#include "framework/registration/nonrigid.h"
#include "framework/registration/residual.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// How far maps of a window lie from a frame. Bound to what the frames show, which changes from frame to
/// frame.
class TrackingErrorMeter {
 public:
  /// All must outlive this. `seen`: over the window. `cut`: mm, of TrackingError::robust.
  TrackingErrorMeter(Device& device, const Correspondence& correspondence, const SurfaceMap& seen, double cut)
      : meter_(device, correspondence, seen, seen.window.size(), cut) {}

  /// Of a point a pixel of the window, in the frame of its camera. Waits for the device.
  TrackingError measure(const PointSet& points);

 private:
  ResidualMeter meter_;
};

/// Registers a deforming model non-rigidly to frames [thesis 4.8].
class ModelRegistration {
 public:
  /// All must outlive this.
  ModelRegistration(Device& device, const NonRigidMethod& method) : device_(device), method_(method) {}

  /// Deforms the model to what a frame shows, `seen`; `view`: the last one of the model, from there. What
  /// comes out is rejected, and the model stays as it was, when it is not finite, lies further from the frame
  /// than before, or folds the surface. Writes `registration` and both errors of the record.
  void run(DeformingModel& model, const SurfaceMap& view, const SurfaceMap& seen,
           const Eigen::Isometry3d& camera_from_model, TrackingErrorMeter& meter, FrameRecord& record) const;

 private:
  Device& device_;
  const NonRigidMethod& method_;
};

}  // namespace pliant
