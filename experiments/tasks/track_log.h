#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/tasks/json_file.h"
#include "experiments/tasks/point_truth.h"
#include "experiments/tasks/track_truth.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// What is told of each frame that is tracked, in files of a folder that grow while it goes on: a run that is
/// killed keeps its frames.
class TrackLog {
 public:
  /// Their names: frames.jsonl, frames.csv and trajectory.txt (the TUM format: where the camera is in the
  /// model's frame, of every frame whose pose was found).
  static const std::vector<std::string>& files();

  /// Throws DataError when a file cannot be written, as add() does.
  explicit TrackLog(const std::filesystem::path& folder);

  /// `error`: of the pose, where the true one is known; `points`: likewise of the points that are followed.
  void add(const FrameRecord& record, const std::optional<PoseError>& error,
           const std::optional<FollowedErrors>& points);

 private:
  JsonLines json_;
  LineFile csv_;
  LineFile trajectory_;
};

}  // namespace pliant
