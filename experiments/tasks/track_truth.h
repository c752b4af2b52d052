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

/// How far a model's surface is from the true one, mm.
struct ModelError {
  double mean = 0;
  double p95 = 0;
};

/// Both move the model to the camera's frame, mm.
PoseError pose_error(const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth);

/// Judges poses and models by those that a stream knows, both seen from the frame that began the model.
class TrackTruth {
 public:
  /// `stream` must outlive this.
  explicit TrackTruth(const DataStream& stream) : stream_(stream) {}

  /// Of the frames of a tracker, each in turn; none where there is no model yet or the truth is not known.
  std::optional<PoseError> error_of(const FrameRecord& record);
  /// Of a model of these frames as it is in frame `number`, at its vertices; none where it has none or the
  /// true surface is not known. The model's frame is that of the frame that began it, and goes with the
  /// object as far as that truly moves rigidly.
  std::optional<ModelError> error_of(const Mesh& model, int number) const;

 private:
  const DataStream& stream_;
  std::optional<Eigen::Isometry3d> world_from_model_;
};

}  // namespace pliant
