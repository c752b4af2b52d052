#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "experiments/view/film_file.h"
#include "experiments/view/frame_picture.h"
#include "experiments/view/frame_rate.h"
#include "experiments/view/track_observer.h"

namespace pliant {

/// Writes the pictures of tracked frames into a film, each when it is there.
class TrackVideo : public TrackObserver {
 public:
  /// Of every `every`-th frame, from the first one on.
  TrackVideo(std::filesystem::path file, int every) : file_(std::move(file)), every_(every) {}

  void begin(const Rig& rig) override { picture_.emplace(rig, panel_width); }
  /// Throws DataError naming the file when it cannot be written.
  bool show(const TrackedFrame& tracked) override;

 private:
  static constexpr int panel_width = 320;

  std::filesystem::path file_;
  int every_;
  std::optional<FramePicture> picture_;
  FrameRate rate_;
  std::unique_ptr<FilmFile> film_;
};

}  // namespace pliant
