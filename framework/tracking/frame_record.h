#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "framework/core/stopwatch.h"
#include "framework/pose/pose_estimator.h"

namespace pliant {

/// What became of a frame.
enum class FrameState {
  waiting,  ///< there is no model yet, and the frame does not show what is to be modelled
  started,  ///< the model was begun with it
  tracked,  ///< its pose was found, and it was fused into the model
  lost,     ///< its pose was not found: the model stays as it is, and the pose that of the frame before
};

/// "waiting", "started", "tracked" or "lost"
std::string to_string(FrameState state);

/// Whether the pose of a frame was found.
bool has_pose(FrameState state);

/// How far the model, where it was found, lies from a frame: from each of its points to the one that the
/// frame has at the same pixel, over those whose match is accepted [thesis 4.2].
struct TrackingError {
  double mean = 0;       ///< mm
  double deviation = 0;  ///< mm, standard deviation
  int matched = 0;       ///< points that it is over
};

/// What registering the model non-rigidly to a frame came to.
struct RegistrationRecord {
  bool is_rejected = false;  ///< the model stays as it was
  std::string reason;        ///< why it is rejected; else why the iterations ended
  int iterations = 0;
  int nodes = 0;
  int constraints = 0;
  int folded_cells = 0;  ///< of the view, between four neighbouring points, turned inside out
};

/// What tracking a frame came to.
struct FrameRecord {
  int number = 0;   ///< of the frame in its stream, the first is 1
  double time = 0;  ///< s
  FrameState state = FrameState::waiting;
  std::string reason;  ///< why it is lost or waiting; else empty
  Eigen::Isometry3d camera_from_model = Eigen::Isometry3d::Identity();  ///< mm; the last one found
  bool relocalized = false;   ///< tracked from where a relocalizer was asked, not from the pose before
  PoseEstimate pose;          ///< of a frame that was tracked or lost
  TrackingError rigid_error;  ///< of a frame that was tracked: at that pose
  TrackingError error;        ///< the same after the model was registered non-rigidly, if it was
  std::optional<RegistrationRecord>
      registration;     ///< of a frame that the policy wants the model registered to
  double total_ms = 0;  ///< from the frame's images to where the next frame may come
  StageTimes time_ms;   ///< of the host by stage, and of the device while it measures them
};

/// Whether the model was registered non-rigidly to the frame, and has taken that up; or not, as it was no
/// better.
bool is_registered(const FrameRecord& record);
bool is_rejected(const FrameRecord& record);

}  // namespace pliant
