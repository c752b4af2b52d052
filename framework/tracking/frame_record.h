#pragma once

#include <Eigen/Geometry>
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

/// What tracking a frame came to.
struct FrameRecord {
  int number = 0;   ///< of the frame in its stream, the first is 1
  double time = 0;  ///< s
  FrameState state = FrameState::waiting;
  std::string reason;  ///< why it is lost or waiting; else empty
  Eigen::Isometry3d camera_from_model = Eigen::Isometry3d::Identity();  ///< mm; the last one found
  bool relocalized = false;  ///< tracked from where a relocalizer was asked, not from the pose before
  PoseEstimate pose;         ///< of a frame that was tracked or lost
  double total_ms = 0;       ///< from the frame's images to where the next frame may come
  StageTimes time_ms;        ///< of the host by stage, and of the device while it measures them
};

}  // namespace pliant
