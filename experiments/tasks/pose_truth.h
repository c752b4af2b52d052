#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "experiments/datasets/frame_source.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// How far a pose is from the true one.
struct PoseError {
  double translation = 0;  ///< mm, between where the camera is in the model's frame
  double rotation = 0;     ///< degrees
};

/// Both move the model to the camera's frame, mm.
PoseError pose_error(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth);

/// Judges poses by those that a stream knows, both seen from the frame that began the model.
class PoseTruth {
 public:
  /// `stream` must outlive this.
  explicit PoseTruth(const DataStream& stream) : stream_(stream) {}

  /// Of the frames of a tracker, each in turn; none where there is no model yet or the truth is not known.
  std::optional<PoseError> error_of(const FrameRecord& record);

 private:
  const DataStream& stream_;
  std::optional<Eigen::Isometry3d> world_from_model_;
};

}  // namespace pliant
