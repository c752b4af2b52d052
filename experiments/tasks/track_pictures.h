#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "experiments/report/artefacts.h"
#include "experiments/tasks/point_tracks.h"
#include "experiments/tasks/task.h"
#include "experiments/view/augmentation_section.h"
#include "experiments/view/error_pictures.h"
#include "experiments/view/picture_strip.h"
#include "experiments/view/surface_attachment.h"
#include "experiments/view/track_video.h"
#include "experiments/view/track_view.h"
#include "framework/tracking/tracker.h"

namespace pliant {

/// What a section of record_table() asks for; null where it asks for none. Throws ConfigError for what is no
/// number of a frame.
std::shared_ptr<ErrorPictures> make_error_pictures(const Parameters& record);

/// Lets everyone watch the frames of a run who is to: its observer, and what makes pictures and tracks of
/// them. Who sees their colour sees it with the run's virtual object.
class TrackPictures {
 public:
  /// `device` must outlive this. Throws DataError naming the file of a virtual object that cannot be read.
  TrackPictures(const ExperimentRun& run, const Making& making, const Rig& rig, Device& device);
  TrackPictures(const TrackPictures&) = delete;
  TrackPictures& operator=(const TrackPictures&) = delete;

  /// What the tracker made of its last frame; gives whether to go on. Throws DataError when a file cannot
  /// be written, or a virtual object is to be drawn over a frame without colour.
  bool show(const Frame& frame, const FrameRecord& record, const Tracker& tracker);
  /// Adds what there is to see; `model`: in the end. Frames that began no model leave at most a film.
  /// Throws DataError when a file cannot be written.
  void add_to(RunArtefacts& made, Mesh model) const;

  static constexpr const char* strip_name = "strip";
  static constexpr const char* errors_name = "errors";
  static constexpr const char* video_name = "video.avi";

 private:
  Eigen::Isometry3d camera_from_surface(const FrameRecord& record, const Tracker& tracker);

  std::shared_ptr<PictureStrip> strip_ = std::make_shared<PictureStrip>();
  std::shared_ptr<TrackView> view_ = std::make_shared<TrackView>();
  std::shared_ptr<ErrorPictures> errors_;  // where they are asked for
  int last_frame_ = 0;                     // of the stream's where it is 0
  std::unique_ptr<PointTracks> tracks_;    // likewise
  std::filesystem::path video_file_;
  std::optional<Augmentation> augmentation_;     // where someone sees it
  double reach_ = 0;                             // mm, of points that carry it
  std::optional<SurfaceAttachment> attachment_;  // once points are followed
  std::optional<TrackVideo> video_;
  std::vector<TrackObserver*> observers_;
};

}  // namespace pliant
