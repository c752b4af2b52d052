#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/tasks/point_truth.h"
#include "experiments/tasks/track_truth.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// What is kept of the frames of a run: little, so that long recordings have room.
struct TrackSummary {
  struct FrameFigures {
    FrameState state;
    float mean_error;    ///< mm; see PoseEstimate
    float inlier_share;  ///< of the model's points that were matched
    float total_ms;
    float translation_error;  ///< mm; NaN where the true pose is not known
    float rotation_error;     ///< degrees, likewise
    float rigid_error;        ///< mm, mean of TrackingError after rigid tracking alone
    float error;              ///< mm, likewise after the model was registered non-rigidly, if it was
    float deviation;          ///< mm, standard deviation of that
    bool is_registered;       ///< see FrameRecord
    bool is_rejected;         ///< likewise
    float point_error;   ///< mm, mean over the visible followed points; NaN where their truth is not known
    float moving_error;  ///< mm, likewise over those that the deformation moves
  };
  std::vector<FrameFigures> frames;
  int relocalized = 0;  ///< of them; see FrameRecord
  StageTimes time_ms;   ///< added up over the frames that mean_ms() is of

  void add(const FrameRecord& record, const std::optional<PoseError>& error,
           const std::optional<FollowedErrors>& points);

  int count(FrameState state) const;
  int count(bool FrameFigures::*flag) const;
  /// Whether any frame has that figure.
  bool knows(float FrameFigures::*figure) const;
  /// Mean of a figure over the frames that were tracked and have it; 0 where none was.
  double mean(float FrameFigures::*figure) const;
  double mean_ms() const;  ///< over the frames that were tracked but the first, which builds kernels; 0: none
  /// Root mean squares over the frames whose pose was found and is known; none where there is no such.
  std::optional<PoseError> rmse() const;
};

}  // namespace pliant
