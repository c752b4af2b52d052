#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>
#include <optional>

#include "experiments/view/frame_picture.h"
#include "experiments/view/frame_rate.h"
#include "experiments/view/track_observer.h"

namespace pliant {

/// Writes the pictures of tracked frames into a film (Motion JPEG in an AVI file, 30 pictures a second),
/// picture by picture.
class TrackVideo : public TrackObserver {
 public:
  /// Of every `every`-th frame, from the first one on.
  TrackVideo(std::filesystem::path file, int every) : file_(std::move(file)), every_(every) {}

  /// Throws DataError naming the file when it cannot be written.
  void begin(const Rig& rig) override;
  bool show(const TrackedFrame& tracked) override;

 private:
  std::filesystem::path file_;
  int every_;
  std::optional<FramePicture> picture_;
  FrameRate rate_;
  cv::VideoWriter writer_;
};

}  // namespace pliant
