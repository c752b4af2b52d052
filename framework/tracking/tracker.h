#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/rig.h"
#include "framework/imaging/preprocessor.h"
#include "framework/pose/focal_length.h"
#include "framework/tracking/followed_window.h"
#include "framework/tracking/frame_record.h"
#include "framework/tracking/model_registration.h"
#include "framework/tracking/tracking_method.h"

namespace pliant {

/// Tracks what a rig sees, frame by frame, against a model that the frames are fused into [thesis chapter 3,
/// Figure 3.1] and that is deformed where rigid motion does not explain them [4.8]. The same frames, method
/// and device give the same bits.
///
/// The model is begun with the first frame that shows the object; the region where the segmentation finds it
/// stays as it is from then on. Where the pose of a frame is not found, the next one is looked for from the
/// last one that was. A frame without any depth in the region is lost.
///
/// With a relocalizer the region, unless it has a mask, moves with the model. Where ICP fails, or the share
/// of the model's points with a match falls by a quarter from one frame to the next, the object is segmented
/// anew and ICP tried from the relocalizer's poses as well; what matches less than that is lost.
class Tracker {
 public:
  /// Method and device must outlive this. Throws DataError as `check` of the rig does.
  Tracker(const TrackingMethod& method, const Rig& rig, Device& device);

  /// The next frame, which fits the rig. Throws DataError when it does not, or when the model cannot be
  /// fitted to what it shows. Frames after one that threw may still be tracked.
  FrameRecord track(const Frame& frame);

  /// Whether a frame has begun the model. What follows asks for one.
  bool has_model() const { return model_ != nullptr; }
  /// The surface of the frame that was tracked last, as Acquisition has it, in the frame of its camera.
  const SurfaceMap& seen() const { return preprocessor_->surface(); }
  /// What that camera would see of the model at the last pose that was found.
  const SurfaceMap& model_view() const { return *model_view_; }
  const DeformingModel& model() const { return *model_; }
  /// Of the points that are followed, the pixel of the frame that began the model where each was seen; none
  /// before they are chosen. The model tells where they are.
  const std::vector<Eigen::Vector2i>& followed_pixels() const { return followed_pixels_; }
  /// With which focal length of the depth camera the tracked frames fit together. Of no view where a policy
  /// deforms the model: what deforms is no measure of the camera.
  FocalLengthEstimate focal_length() const {
    return focal_length_ ? focal_length_->estimate() : FocalLengthEstimate{};
  }

 private:
  bool find_object(const Frame& frame, FrameRecord& record);
  std::optional<Region> find_region(const Frame& frame, FrameRecord& record) const;
  void preprocess(const Frame& frame);
  void begin_model(FrameRecord& record);
  void follow(const Frame& frame, FrameRecord& record);
  bool is_sure(const PoseEstimate& pose) const;
  void relocalise(const Frame& frame, FrameRecord& record);
  struct Found {
    Eigen::Isometry3d start;  // camera_from_model, mm, that ICP began with
    PoseEstimate pose;
  };
  std::optional<Found> search(const Frame& frame, FrameRecord& record);
  PoseEstimate estimate_from(const Eigen::Isometry3d& camera_from_model);
  void remember(const Frame& frame, FrameRecord& record);
  void register_model(FrameRecord& record);
  void fuse_into(DeformingModel& model);
  void choose_followed();

  const TrackingMethod& method_;
  Rig rig_;
  Device& device_;
  Region region_;                             // once it is known, of the next frame
  std::optional<Preprocessor> preprocessor_;  // likewise
  std::unique_ptr<PoseEstimator> pose_;
  std::unique_ptr<Relocalizer> relocalizer_;  // null without
  std::optional<FollowedWindow> window_;      // of a region without a mask, with a relocalizer
  double usual_share_ = 0.8;                  // of the model's points that are matched: in the last frame
  TrackingErrorMeter meter_;
  std::optional<PolicyInput::Rejection> rejection_;  // if the last registration was
  std::unique_ptr<DeformingModel> model_;
  const SurfaceMap* model_view_ = nullptr;
  SurfaceMap moved_view_;     // to the pose of the frame
  PixelWindow first_window_;  // of the frame that began the model
  std::vector<Eigen::Vector2i> followed_pixels_;
  std::optional<FocalLengthCheck> focal_length_;  // once there is a model, of what is rigid
  Eigen::Isometry3d camera_from_model_ = Eigen::Isometry3d::Identity();
  int count_ = 0;  // of frames
};

}  // namespace pliant
