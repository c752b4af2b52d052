#pragma once

#include <optional>
#include <vector>

#include "framework/core/angle.h"
#include "framework/core/parameters.h"
#include "framework/device/array.h"
#include "framework/geometry/surface_map.h"
#include "framework/registration/residual.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// What counts as the distance between a model and a frame.
struct TrackingErrorOptions {
  double max_distance = 30;  ///< mm; what is further apart in depth does not belong together
  /// Radians between a point's normal and the way to the camera; depth tells little of what turns away more.
  double max_view_angle = 75 * degree;
  /// Pixels; the mean over so many to each side counts: noise is averaged out, a deformation is not. 0: none
  /// is.
  int radius = 3;
  /// Share by which it must fall for a registration to be kept.
  double min_gain = 0.05;
};

ParameterTable tracking_error_table();
TrackingErrorOptions read_tracking_error(const Parameters& section);

/// Measures how far a model lies from frames, on a device.
class TrackingErrorMeter {
 public:
  /// The device must outlive this.
  TrackingErrorMeter(Device& device, const TrackingErrorOptions& options);

  /// `model`: where it is in the frame of the camera that saw the frame. Waits for the device.
  TrackingError measure(const SurfaceMap& model, const SurfaceMap& seen);
  /// What was measured last, a pixel of the model's window: mm, -1 where nothing is known.
  const Array<float>& per_pixel() const { return distances_; }

 private:
  Device& device_;
  TrackingErrorOptions options_;
  Array<float> differences_;
  Array<float> sums_;
  Array<float> distances_;
  std::optional<ResidualSum> sum_;
};

/// Plain C++ reference of what TrackingErrorMeter measures a pixel.
std::vector<float> tracking_error_reference(const SurfaceMap& model, const SurfaceMap& seen,
                                            const TrackingErrorOptions& options);

}  // namespace pliant
